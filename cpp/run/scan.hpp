#pragma once

#include "run/series.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace firetwin::run {

/// W/m2: a cell with less heat flux than this, and none with more before, does not burn.
///
/// Models leave traces where nothing burns: half of the positive fluxes of CFBM are below 1 W/m2,
/// down to 1e-38. The weakest flames that there are, 10 cm high, release 1.7 kW a metre of front
/// (L = 0.0775 I^0.46, Byram 1959); a front of them through a cell as large as 1.7 km gives it
/// 1 W/m2.
constexpr float least_fire = 1.0F;

/// What one pass over all heat fluxes of a run tells. It does not depend on the number of threads.
struct Scan {
  static constexpr std::uint32_t never = 0xFFFFFFFF;

  /// Of one cell. Times are in s after the first model time.
  struct Cell {
    std::uint32_t first = never; ///< first time index with a flux of `least_fire`, or never
    float flux = 0.0F;           ///< W/m2 at that time
    float next = 0.0F;           ///< and at the one after it; NaN where the run ends
    float last = 0.0F;           ///< at the last time of the run
    double heat = 0.0;           ///< J/m2 over the run, by the trapezoidal rule
    double moment = 0.0;         ///< J s/m2, the same with each moment's heat times its time
  };

  /// Of the finite fluxes, W/m2; above `largest` when there is none.
  float smallest = std::numeric_limits<float>::infinity();
  float largest = -std::numeric_limits<float>::infinity();
  std::size_t not_finite = 0; ///< NaN and infinities
  std::size_t negative = 0;
  std::vector<Cell> cells;
};

/// Reads every frame once, in order.
/// @param times as many as frames, s
/// @throws what reading a frame throws
Scan scan(const Series& flux, const std::vector<double>& times);

} // namespace firetwin::run
