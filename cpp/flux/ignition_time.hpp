#pragma once

#include "run/run.hpp"

#include <vector>

namespace firetwin::flux {

/// Ignition time of each cell [ny nx], s, from the heat flux alone, between model times: the front
/// reaches the cell and its flux begins. NaN where the cell never burns; the first model time where
/// it burns from the start.
///
/// A cell whose flux is first that of a fire (run::least_fire) at t1, after an interval d, began
/// at t1 - s with 0 <= s <= d. Three estimates of s are averaged by their variances.
///
/// Growth: a front that sweeps a cell lets its flux grow linearly, F = k s. Fluxes are means over
/// a <= d seconds before their time (mean_s of run.toml, else d): the first is k s^2 / 2a where
/// s < a, else k (s - a / 2), and the next, a mean over b seconds and e later, is k (s + g) with
/// g = e - b / 2. So from their ratio r
///   s = a r + sqrt(a r (a r + 2 g)) where that is below a, else (a / 2 + r g) / (1 - r).
/// Its standard deviation is 0.2 d. Without growth, or with s above d, it is s = d / 2 with that of
/// a uniform distribution, d / sqrt(12).
///
/// Front: near a cell a front is straight and steady, so the cell's time is the mean of those of
/// two opposite neighbours. The least squares plane through the 3 x 3 times t1 - d / 2 (as far as
/// neighbours come in pairs) averages what is uniform in each of them; pairs that begin in the
/// cell's own interval tell nothing and are left out. Its variance follows from
/// how far the pairs' means lie from the cell, d^2 / 12 at least.
///
/// Band: a cell between the fronts of two model times, d0 cells from the nearest that burned before
/// and d1 from the nearest that does not burn yet, begins (d0 - 1/2) / (d0 + d1 - 1) of the
/// interval after the first, give or take 1 / (d0 + d1 - 1) (uniform).
std::vector<double> ignition_time_from_flux(const run::Run& run);

} // namespace firetwin::flux
