#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::flux {

/// Time a front takes to cross a cell of [rows columns], s: the sum over both axes of the
/// difference of times to the next cell. Times may be NaN. It is 0 without neighbours.
///
/// Along an axis it is the mean of the differences to both sides, but not more than twice the
/// smaller: a jump to another fire's time is no slow front.
double crossing_time(std::span<const float> time, std::size_t columns, std::size_t cell);
double crossing_time(std::span<const double> time, std::size_t columns, std::size_t cell);

/// [rows columns] of all cells.
std::vector<double> crossing_time(std::span<const double> time, std::size_t columns);

} // namespace firetwin::flux
