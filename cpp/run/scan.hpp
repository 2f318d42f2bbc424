#pragma once

#include "run/series.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace firetwin::run {

/// Flux threshold of fire, W/m2: a cell does not burn before its flux reaches it.
///
/// Models output tiny fluxes in unburned cells: half of the positive fluxes of CFBM are below 1
/// W/m2, down to 1e-38. The weakest flames, 10 cm high, release 1.7 kW per metre of front (L =
/// 0.0775 I^0.46, Byram 1959); such a front in a cell of 1.7 km gives a flux of 1 W/m2.
constexpr float min_fire_flux = 1.0F;

/// Statistics of one pass over all heat fluxes of a run. Independent of the number of threads.
struct Scan {
  static constexpr std::uint32_t never = 0xFFFFFFFF;

  /// Statistics of one cell. Times are in s after the first model time.
  struct Cell {
    std::uint32_t first = never; ///< first time index with a flux of `min_fire_flux`, or never
    float flux = 0.0F;           ///< W/m2 at that time
    float next = 0.0F;           ///< W/m2 at the following time; NaN at the end of the run
    float last = 0.0F;           ///< W/m2 at the last time of the run
    double heat = 0.0;           ///< J/m2 over the run, by the trapezoidal rule
    double moment = 0.0;         ///< J s/m2, first moment in time of the heat
  };

  /// Range of the finite fluxes, W/m2; smallest > largest without one.
  float smallest = std::numeric_limits<float>::infinity();
  float largest = -std::numeric_limits<float>::infinity();
  std::size_t not_finite = 0; ///< NaN and infinities
  std::size_t negative = 0;
  std::vector<Cell> cells;
};

/// Reads every frame once, in order.
/// @param times one per frame, s
/// @throws the error of reading a frame
Scan scan(const Series& flux, const std::vector<double>& times);

} // namespace firetwin::run
