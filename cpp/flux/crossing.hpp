#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::flux {

/// s that a front takes from the first corner of a cell of [rows columns] to its last: the sum
/// along both axes of how much later the next cell comes, from times that may be NaN; 0 without
/// neighbours.
///
/// Along an axis it is the mean of the differences to both sides, but not more than twice the
/// smaller: a jump to another fire's time is no slow front.
double crossing_time(std::span<const float> time, std::size_t columns, std::size_t cell);
double crossing_time(std::span<const double> time, std::size_t columns, std::size_t cell);

/// [rows columns] of all cells.
std::vector<double> crossing_time(std::span<const double> time, std::size_t columns);

} // namespace firetwin::flux
