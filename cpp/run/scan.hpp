#pragma once

#include "run/series.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace firetwin::run {

/// One pass over all heat fluxes of a run. The result does not depend on the number of threads.
struct Scan {
  static constexpr std::uint32_t never = 0xFFFFFFFF;

  float smallest; ///< of the finite fluxes, W/m2; above `largest` when there is none
  float largest;
  std::size_t not_finite = 0; ///< NaN and infinities
  std::size_t negative = 0;
  std::vector<std::uint32_t> first; ///< per cell: first time index with flux > threshold, or never
};

Scan scan(const Series& flux, double threshold);

} // namespace firetwin::run
