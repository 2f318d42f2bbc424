#pragma once

#include "run/run.hpp"

#include <vector>

namespace firetwin::flux {

/// [ny nx] time in s since start when each cell begins to burn, between model times; NaN where it
/// never does, the first model time where it burns from the beginning.
///
/// A cell whose flux is first above 0 at t1, after an interval d, began at t1 - s with 0 <= s <= d.
/// Two estimates of s are averaged by their variances.
///
/// Growth: a front that sweeps a cell lets its flux grow linearly, F = k s. From the ratio r of the
/// first flux to the next, an interval e later, where the flux is
///   a mean over each interval: k s^2 / 2d and k (s + e / 2), so s = r d + sqrt(r d (r d + e));
///   a value at each time: k s and k (s + e), so s = r e / (1 - r).
/// Its standard deviation is 0.2 d. Without growth, or with s above d, it is s = d / 2 with that of
/// a uniform distribution, d / sqrt(12).
///
/// Front: near a cell a front is straight and steady, so the cell's time is the mean of those of
/// two opposite neighbours. The least squares plane through the 3 x 3 times t1 - d / 2 (as far as
/// neighbours come in pairs) averages what is uniform in each of them. Its variance follows from
/// how far the pairs' means lie from the cell, d^2 / 12 at least.
///
/// @param averaged whether fluxes are means over the interval that ends at their time
std::vector<float> arrival_time(const run::Run& run, bool averaged);

} // namespace firetwin::flux
