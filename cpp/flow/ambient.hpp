#pragma once

#include "flow/field.hpp"
#include "flow/transport.hpp"
#include "flow/water.hpp"

#include <array>
#include <vector>

namespace firetwin::flow {

/// The air before the fire. Heights are above the mean ground; values are linear between them and
/// constant outside.
struct Profile {
  std::vector<double> height;                ///< [n] m, rising
  std::vector<double> potential_temperature; ///< [n] K
  std::vector<std::array<double, 2>> wind;   ///< [n] east and north, m/s, over height above ground
  std::vector<double> water;                 ///< [n] kg/kg, or empty: dry
  double pressure = 101325.0;                ///< at height 0, Pa
};

/// Linear between points, constant outside.
double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at);

/// Ground [ny][nx] in cells, m, and how the levels follow it: a point of height z' above ground
/// stands at mean + z' + (ground - mean) (1 - z' / top), so that the topmost level is even.
class Ground {
public:
  Ground(const Lattice& lattice, std::vector<double> height);
  /// With the mean and the top of a box around it.
  Ground(const Lattice& lattice, std::vector<double> height, const Ground& around);

  /// Of the ground above its mean, m.
  double above(Index j, Index i) const { return above_[static_cast<std::size_t>(j * nx_ + i)]; }
  /// Part of the ground's shape that is left at height z'.
  double share(double height) const { return height < top_ ? 1.0 - height / top_ : 0.0; }
  /// Thickness of a layer here over its thickness above the mean ground.
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

/// The profile on a lattice: what air weighs there, and the state of rest.
class Ambient {
public:
  Ambient(const Lattice& lattice, const Ground& ground, const Profile& profile);

  bool moist() const { return moist_; }
  const Air& air() const { return air_; }
  double density(Index k) const { return density_[static_cast<std::size_t>(k)]; }
  double exner(Index k) const { return exner_[static_cast<std::size_t>(k)]; }
  double pressure(Index k) const { return pressure_[static_cast<std::size_t>(k)]; }
  /// Potential temperatures are kept as what they are above this one, K: four digits more.
  double reference() const { return reference_; }
  const Field& theta() const { return theta_; } ///< K above the reference
  const Field& water() const { return water_; }
  const Field& heaviness() const { return virtual_; } ///< virtual potential temperature, K
  const std::vector<std::array<float, 2>>& wind() const { return wind_; } ///< [nz]

  /// @return what was added to the wind of each level
  std::vector<std::array<float, 2>> set_wind(const Lattice& lattice, const Profile& profile);

  /// What `virtual_row` asks for in level k.
  Weather weather(Index k) const {
    return {static_cast<float>(reference_), static_cast<float>(exner(k)),
            static_cast<float>(pressure(k))};
  }

private:
  void weigh(const Lattice& lattice, const Profile& profile);
  void rest(const Lattice& lattice, const Ground& ground, const Profile& profile);

  bool moist_;
  Air air_;
  double reference_;
  std::vector<double> density_, exner_, pressure_;
  std::vector<std::array<float, 2>> wind_;
  Field theta_, water_, virtual_;
};

} // namespace firetwin::flow
