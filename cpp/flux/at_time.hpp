#pragma once

#include "run/run.hpp"

#include <vector>

namespace firetwin::flux {

/// Heat flux [ny nx] in W/m2 at any time (s since start): exact at the model times, zero before the
/// first and after the last.
///
/// Size and colour of the flames go with F^1.5 (see emitters.hpp), so between two model times the
/// sum of F^1.5 changes linearly, and nothing pulses once a model step:
/// - In a cell that burned before, F^1.5 changes linearly.
/// - A cell that first burns in between stays cold until the front arrives, so the
///   front moves instead of lighting all its new cells at once. Its F^1.5 then rises over the share
///   of the interval that it has in the F^1.5 of all new cells. Lit one after the other in this
///   way, in the order of their arrival, the sum of the new cells would rise linearly. They may be
///   ahead of that or behind it by a few percent of what the other cells have; an arrival that asks
///   for more is moved. When the front arrives is told by arrival.hpp and by where the cell lies
///   between the fronts of the two model times.
/// - What is then still off is made good by one factor for all cells, within 5 % for F^1.5.
///
/// NaN where a cell that burned before has NaN in one of the two frames. Cells below 0 take no part
/// in this and change linearly. The first call scans the run for its arrival times.
/// @throws std::invalid_argument when time is NaN.
std::vector<float> at_time(const run::Run& run, double time);

} // namespace firetwin::flux
