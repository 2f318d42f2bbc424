#include "flux/distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace firetwin::flux {

Distance::Distance(std::span<const std::uint8_t> marked, std::size_t rows, std::size_t columns)
    : columns_(columns), vertical_(marked.size(), std::numeric_limits<double>::infinity()) {
  for (std::size_t i = 0; i < marked.size(); ++i) {
    const double above = i >= columns ? vertical_[i - columns] + 1.0 : vertical_[i];
    vertical_[i] = marked[i] ? 0.0 : above;
  }
  for (std::size_t i = (rows - 1) * columns; i-- > 0;) {
    vertical_[i] = std::min(vertical_[i], vertical_[i + columns] + 1.0);
  }
}

double Distance::from(std::size_t y, std::size_t x) const {
  const double* row = vertical_.data() + y * columns_;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < columns_; ++i) {
    const double across = static_cast<double>(i) - static_cast<double>(x);
    least = std::min(least, across * across + row[i] * row[i]);
  }
  return std::sqrt(least);
}

} // namespace firetwin::flux
