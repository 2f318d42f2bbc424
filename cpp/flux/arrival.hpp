#pragma once

#include "run/run.hpp"

#include <vector>

namespace firetwin::flux {

/// Fire arrival time: the front passes the centre of a cell, s; NaN where it does not within the
/// run. Flames, terrain, smoke and the interpolation of fluxes all use it.
///
/// The run's own fuel_arrival_time where it has one. Else from the fluxes: when a cell begins
/// (ignition_time.hpp) and how its heat is released tell when the front is in its middle.
///
/// Slope: neighbours that begin later tell how long the front takes across a cell, c; the middle
/// is reached c / 2 after the beginning. Where the front is ragged that is off by 0.8 c (measured).
///
/// Heat: it is released around the mean time of arrival in the cell, later by how long the fuel
/// burns. That delay is the same for all cells: the median of what the slopes leave over in cells
/// that have burned out and have neighbours on all sides. Its standard deviation is half of it.
/// A cell at the edge of the fire burns in part: its share is its heat for its fuel over that of
/// such cells near it, and in a cell still burning when the run ends the share tells how far the
/// front has come in it. Heat alone tells that where cells burn of which the run knows no fuel.
///
/// Both are averaged by their variances. On the sample run without its own arrival times, fluxes of
/// 370 m cells each minute or each quarter of an hour, the front is off by 43 m in the mean (area
/// between the lines over the front's length, as tests/benchmarks/scale.py counts it) and lies 12 m
/// too far in (130 m and 129 m out when cells burn from the first model time with flux).

/// [ny nx] at the centres of the model grid's cells.
std::vector<double> arrival_time(const run::Run& run);

/// [fy fx] at the centres of the fuel cells: without the run's own bilinear between the model
/// cells', and inside the line where half of the ground around has burned by the end of the run.
/// Where the run knows the fuel of all that burns, a fuel cell without any does not.
std::vector<double> fuel_arrival_time(const run::Run& run);

/// Ignition time of each cell of the model grid [ny nx], s: the earliest of its fuel cells with the
/// run's own arrival times, else as in ignition_time.hpp; NaN where never.
std::vector<double> ignition_time(const run::Run& run);

} // namespace firetwin::flux
