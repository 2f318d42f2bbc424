#pragma once

#include "run/run.hpp"

#include <vector>

namespace firetwin::flux {

/// Fire arrival time: when the front passes the centre of a cell, s; NaN if it does not during the
/// run. Flames, terrain, smoke and the interpolation of fluxes use it.
///
/// It is the run's field fuel_arrival_time if there is one. Otherwise it is estimated from the heat
/// flux: from the ignition time of a cell (ignition_time.hpp) and the time course of its heat
/// release.
///
/// Slope: neighbours that ignite later give the time c that the front takes to cross a cell; it
/// reaches the centre c / 2 after ignition. For a ragged front the error is 0.8 c (measured).
///
/// Heat: it is released around the mean arrival time in the cell plus a delay, the burning time of
/// the fuel. The delay is uniform: the median of the residuals of the slope estimate over
/// burned-out cells with neighbours on all sides. Its standard deviation is half of it. A cell at
/// the edge of the fire burns partly: its share is its heat per fuel divided by the heat per fuel
/// of burned-out cells near it. In a cell that still burns when the run ends, the share gives the
/// position of the front. If the fuel of burning cells is unknown, shares are ratios of heat alone.
///
/// The two estimates are averaged with inverse-variance weights. Error on the sample run without
/// fuel_arrival_time, for fluxes of 370 m cells every minute or every quarter of an hour: the front
/// is displaced by 43 m on average (area between the fronts / length of the front, see
/// tests/benchmarks/scale.py), with a bias of 12 m inwards. If cells ignited at the first model
/// time with flux, it would be 130 m, with a bias of 129 m outwards.

/// Arrival time [ny nx] at the cell centres of the model grid, s.
std::vector<double> arrival_time(const run::Run& run);

/// Arrival time [fy fx] at the centres of the fuel cells, s. Without the run's field it is
/// interpolated bilinearly between model cells, within the line where half of the surroundings has
/// burned by the end of the run. If the run has fuel in all burning cells, fuel cells without fuel
/// do not burn.
std::vector<double> fuel_arrival_time(const run::Run& run);

/// Ignition time of each cell of the model grid [ny nx], s: the earliest arrival in its fuel cells
/// if the run has fuel_arrival_time, else as in ignition_time.hpp; NaN if it never ignites.
std::vector<double> ignition_time(const run::Run& run);

} // namespace firetwin::flux
