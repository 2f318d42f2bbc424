#pragma once

#include "flow/field.hpp"
#include "flow/thermodynamics.hpp"
#include "flow/transport.hpp"

#include <array>
#include <vector>

namespace firetwin::flow {

/// Vertical profile of the ambient air (sounding). Heights are above the mean ground. Values are
/// linear between heights, constant outside.
struct Profile {
  std::vector<double> height;                ///< [n] m, rising
  std::vector<double> potential_temperature; ///< [n] K
  std::vector<std::array<double, 2>> wind; ///< [n] east and north, m/s; heights above local ground
  std::vector<double> water;               ///< [n] water mixing ratio, kg/kg; empty: dry air
  double pressure = 101325.0;              ///< at height 0, Pa
};

/// Interpolates linearly between points, constant outside.
double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at);

/// Terrain-following coordinate (Gal-Chen and Somerville 1975): a point at height z' above ground
/// has the elevation mean + z' + (terrain - mean) (1 - z' / top). The topmost level is even.
class Terrain {
public:
  Terrain(const Lattice& lattice, std::vector<double> height);
  /// Terrain of a nest, with the mean and the top of the outer domain.
  Terrain(const Lattice& lattice, std::vector<double> height, const Terrain& around);

  /// Height of the ground above its mean, m.
  double above(Index j, Index i) const { return above_[static_cast<std::size_t>(j * nx_ + i)]; }
  /// Share of the terrain's relief that levels at height z' have.
  double share(double height) const { return height < top_ ? 1.0 - height / top_ : 0.0; }
  /// Jacobian: thickness of a layer over its thickness above the mean ground.
  double thickness(Index j, Index i) const { return 1.0 - above(j, i) / top_; }
  double mean() const { return mean_; }
  bool flat() const { return flat_; }

private:
  void take(const Lattice& lattice, const std::vector<double>& height);

  Index nx_;
  double mean_ = 0.0;
  double top_;
  bool flat_ = true;
  std::vector<double> above_;
};

/// Ambient (base) state on a lattice: density, Exner function, pressure, and temperature and wind
/// at rest.
class Ambient {
public:
  Ambient(const Lattice& lattice, const Terrain& ground, const Profile& profile);

  bool moist() const { return moist_; }
  const Air& air() const { return air_; }
  double density(Index k) const { return density_[static_cast<std::size_t>(k)]; }
  double exner(Index k) const { return exner_[static_cast<std::size_t>(k)]; }
  double pressure(Index k) const { return pressure_[static_cast<std::size_t>(k)]; }
  /// Reference potential temperature, K. Fields store the difference from it, which gains four
  /// digits.
  double reference() const { return reference_; }
  const Field& theta() const { return theta_; } ///< potential temperature minus the reference, K
  const Field& water() const { return water_; }
  const Field& virtual_theta() const {
    return virtual_theta_;
  } ///< virtual potential temperature, K
  const std::vector<std::array<float, 2>>& wind() const { return wind_; } ///< [nz]

  /// Changes the ambient wind. @return the change of each level's wind, m/s
  std::vector<std::array<float, 2>> set_wind(const Lattice& lattice, const Profile& profile);

  /// Reference values of level k for `virtual_row`.
  LevelReference level_reference(Index k) const {
    return {static_cast<float>(reference_), static_cast<float>(exner(k)),
            static_cast<float>(pressure(k))};
  }

private:
  void set_hydrostatic(const Lattice& lattice, const Profile& profile);
  void rest(const Lattice& lattice, const Terrain& ground, const Profile& profile);

  bool moist_;
  Air air_;
  double reference_;
  std::vector<double> density_, exner_, pressure_;
  std::vector<std::array<float, 2>> wind_;
  Field theta_, water_, virtual_theta_;
};

} // namespace firetwin::flow
