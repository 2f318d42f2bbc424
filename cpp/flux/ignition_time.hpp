#pragma once

#include "run/run.hpp"

#include <limits>
#include <vector>

namespace firetwin::flux {

/// Time of a cell that does not burn.
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Ignition time of each cell [ny nx], s, from the heat flux alone: when the front reaches the
/// cell, with a resolution finer than the model times. NaN if the cell never burns; the first model
/// time if it burns from the start.
///
/// A cell whose flux first reaches run::min_fire_flux at t1, after an interval d, ignited at t1 - s
/// with 0 <= s <= d. Three estimates of s are averaged with inverse-variance weights.
///
/// Growth: while the front crosses a cell, its flux grows linearly, F = k s. Fluxes are means over
/// a <= d seconds before their time (mean_s of run.toml, else d): the first is k s^2 / 2a if s < a,
/// else k (s - a / 2), and the next, a mean over b seconds and e later, is k (s + g) with g = e -
/// b / 2. Hence, with their ratio r,
///   s = a r + sqrt(a r (a r + 2 g)) if that is below a, else (a / 2 + r g) / (1 - r)
/// with a standard deviation of 0.2 d. Without growth, or with s above d, s = d / 2 with the
/// standard deviation of a uniform distribution, d / sqrt(12).
///
/// Front: locally a front is straight and steady, so the cell's time is the mean of two opposite
/// neighbours' times. A least-squares plane through the 3 x 3 times t1 - d / 2 (complete pairs
/// only) averages their uniform errors; pairs that ignite in the cell's own interval carry no
/// information and are skipped. The variance follows from the deviations of the pairs' means from
/// the cell, at least d^2 / 12.
///
/// Band: a cell between the fronts of two model times, d0 cells from the nearest burned cell and d1
/// from the nearest unburned one, ignites at the fraction (d0 - 1/2) / (d0 + d1 - 1) of the
/// interval, with a uniform error of 1 / (d0 + d1 - 1).
std::vector<double> ignition_time_from_flux(const run::Run& run);

} // namespace firetwin::flux
