#pragma once

#include <cstddef>
#include <vector>

namespace firetwin::flux {

/// [rows columns] s that a front takes from a cell's first corner to its last: the sum along both
/// axes of how much later the next cell comes, from times that may be NaN; 0 without neighbours.
///
/// Along an axis it is the mean of the differences to both sides, but not more than twice the
/// smaller: a jump to another fire's time is no slow front.
std::vector<double> crossing_time(const std::vector<double>& time, std::size_t columns);

} // namespace firetwin::flux
