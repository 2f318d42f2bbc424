#pragma once

#include "run/run.hpp"

#include <vector>

namespace firetwin::flux {

/// Heat flux [ny nx] in W/m2 at any time (s since start): exact at the model times, linear between
/// them, zero before the first and after the last. NaN where a frame that is used has NaN.
/// @throws std::invalid_argument when time is NaN.
std::vector<float> at_time(const run::Run& run, double time);

} // namespace firetwin::flux
