#pragma once

#include "run/run.hpp"

#include <vector>

namespace firetwin::flux {

/// Heat flux [ny nx] in W/m2 at any time (s since start): exact at the model times, zero before the
/// first and after the last.
///
/// Between two model times cells that burned before change linearly. A cell that first burns
/// between them stays cold until the front arrives, then rises linearly to its flux at the later
/// time: so the front moves instead of lighting all its new cells at once. The front's arrival
/// within the interval is where the cell lies between the two fronts: (d0 - 1/2) / (d0 + d1 - 1),
/// with the distances in cells d0 to the nearest cell that burned before and d1 to the nearest that
/// does not burn yet. Without either it is the beginning. The first call scans the run for its
/// arrival times.
///
/// NaN where one of the two frames has NaN.
/// @throws std::invalid_argument when time is NaN.
std::vector<float> at_time(const run::Run& run, double time);

} // namespace firetwin::flux
