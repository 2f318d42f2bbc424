#pragma once

#include "base/constants.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::volume {

/// Burned cells, n of them; positions are (n, 3) and winds (n, 2), row by row.
struct Burn {
  std::span<const double> arrival;  ///< s
  std::span<const double> fuel;     ///< kg/m2 consumed
  std::span<const double> position; ///< m
  std::span<const double> wind;     ///< m/s east and north at 10 m, when the cell burned
  double cell_area = 0.0;           ///< m2
};

struct PuffSettings {
  double interval = 60.0;       ///< s of emission gathered in one puff
  double max_age = 5400.0;      ///< s
  double burn_time = 600.0;     ///< s in which a cell burns out, at a constant rate
  double stability = 1.0e-4;    ///< 1/s2, square of the buoyancy frequency
  double block = 400.0;         ///< m, side of the squares whose cells share a puff
  double merge_radius = 2000.0; ///< m, distance within which plumes merge
  double smallest = 50.0;       ///< m, radius of the smallest surface ball
  double turbulence = 1.0;      ///< 0 keeps every puff on the axis of its plume
  double smoke_fraction = 0.02; ///< of burned fuel (WRF-SFIRE's fire_tracer_smoke)
  double heat_of_combustion = constants::heat_of_combustion; ///< J/kg
  std::uint64_t seed = 0;
};

/// Puff smoke at one time, as balls. Balls of mass 0 shape the surface of their parent puff.
struct Puffs {
  std::vector<float> position; ///< (n, 3) m
  std::vector<float> radius;   ///< m
  std::vector<float> density;  ///< kg/m3 of the puff's own smoke; a surface ball has its parent's
  std::vector<float> age;      ///< s
  std::vector<double> mass;    ///< kg
  std::vector<std::uint64_t> identity; ///< identifier of a ball, constant in time
  double emitted = 0.0;                ///< kg of smoke up to this time
  double left = 0.0;                   ///< kg of it that is too old or too thin to be shown
  double heat_per_smoke = 0.0;         ///< J released per kg of smoke

  std::size_t size() const { return radius.size(); }
};

/// Computes puff smoke at `time` in closed form: no earlier state is needed.
///
/// Cells are grouped in blocks. The fuel that a block burns in one interval makes one puff, which
/// starts at the beginning of the interval without mass and size. For its first minutes the puff is
/// a chain of six smaller ones, its stem, so that the column is continuous down to the flames; then
/// the mass passes smoothly to the puff itself. It moves along its plume (see Plume) with the power
/// of its neighbourhood: the sum of P_j exp(-(d_j / merge_radius)^2) over the blocks burning in the
/// same interval, since fires whose plumes touch rise together. It grows by entrainment and
/// turbulence, R = R0 + 0.3 h + 0.02 x (Briggs: radius proportional to rise; x is the drift), from
/// the radius of its fire, R0 = sqrt(P / (pi 1e5 W/m2)), and is diluted as it grows. After half of
/// max_age its mass fades and is added to `left`. Its surface has sixteen balls of 0.28-0.5 R, and
/// each of these has nine balls of 0.3-0.5 of its radius, if they are larger than
/// `smallest`.
/// @throws std::invalid_argument unless all numbers are finite, and the area and the settings
/// (except turbulence) are above 0
Puffs puffs(double time, const Burn& burn, const PuffSettings& settings);

} // namespace firetwin::volume
