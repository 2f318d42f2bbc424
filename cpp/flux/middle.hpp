#pragma once

#include "run/run.hpp"

#include <vector>

namespace firetwin::flux {

/// When the front passes the middle of each cell of the model grid, from the fluxes: see
/// arrival.hpp.
struct Middle {
  /// [ny nx] s. Beyond the end of the run where the front has not come that far; in cells that
  /// never burn beside such that do the time that would follow from theirs; NaN elsewhere.
  std::vector<double> time;
  /// [ny nx] 0..1, part of each cell that has burned when the run ends.
  std::vector<float> share;
};

Middle middle_from_flux(const run::Run& run);

} // namespace firetwin::flux
