#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::flux {

/// Time a front takes to cross a cell of [rows columns], s: the sum over both axes of the
/// difference of times to the next cell. Times may be NaN. The result is 0 without neighbours.
///
/// Along an axis it is the mean difference to both sides, limited to twice the smaller one: a jump
/// to the time of another fire is not a slow front.
double crossing_time(std::span<const float> time, std::size_t columns, std::size_t cell);
double crossing_time(std::span<const double> time, std::size_t columns, std::size_t cell);

/// Crossing times [rows columns] of all cells, s.
std::vector<double> crossing_time(std::span<const double> time, std::size_t columns);

} // namespace firetwin::flux
