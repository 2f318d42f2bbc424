#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace firetwin::terrain {

/// The interval of an axis of `count` points that an index is in, and how far it is in it.
struct Interval {
  std::size_t first, second;
  double part;

  Interval(double index, std::size_t count) {
    const double last = count > 2 ? static_cast<double>(count - 2) : 0.0;
    const double whole = index > 0.0 ? std::min(std::floor(index), last) : 0.0; // NaN: 0
    first = static_cast<std::size_t>(whole);
    second = std::min(first + 1, count - 1);
    part = index - whole;
  }
};

/// Value of a field [rows columns] between its points; beyond its ends as between the last two.
inline double bilinear(const double* field, std::size_t rows, std::size_t columns, double row,
                       double column) {
  const Interval i(row, rows), j(column, columns);
  const double *low = field + i.first * columns, *high = field + i.second * columns;
  const double below = low[j.first] * (1.0 - j.part) + low[j.second] * j.part;
  const double above = high[j.first] * (1.0 - j.part) + high[j.second] * j.part;
  return below * (1.0 - i.part) + above * i.part;
}

} // namespace firetwin::terrain
