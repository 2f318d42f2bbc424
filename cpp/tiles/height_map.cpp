#include "tiles/height_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace firetwin::tiles {
namespace {

constexpr double slack = 1e-9; // in barycentric units: a point on an edge belongs to both triangles

/// First and last grid line within a range; empty if last < first.
struct Lines {
  std::ptrdiff_t first, last;
};

Lines lines(double a, double b, double c, std::size_t count) {
  const double low = std::clamp(std::min({a, b, c}), -1.0, static_cast<double>(count));
  const double high = std::clamp(std::max({a, b, c}), -1.0, static_cast<double>(count));
  return {std::max<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(std::ceil(low - slack)), 0),
          std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(std::floor(high + slack)),
                                   static_cast<std::ptrdiff_t>(count) - 1)};
}

} // namespace

HeightMap::HeightMap(std::array<double, 2> low, double step, std::size_t rows, std::size_t columns)
    : low_(low), step_(step), rows_(rows), columns_(columns),
      height_(rows * columns, std::numeric_limits<float>::quiet_NaN()) {
  if (!(step > 0.0)) {
    throw std::invalid_argument("step must be above 0");
  }
}

void HeightMap::add(std::span<const float> position, std::array<double, 3> origin,
                    std::span<const std::uint32_t> triangle) {
  const std::size_t count = position.size() / 3;
  if (std::ranges::any_of(triangle, [&](std::uint32_t vertex) { return vertex >= count; })) {
    throw std::out_of_range("triangle refers to a vertex that does not exist");
  }
  for (std::size_t first = 0; first + 3 <= triangle.size(); first += 3) {
    std::array<Corner, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const float* vertex = position.data() + 3 * static_cast<std::size_t>(triangle[first + k]);
      corners[k] = {(vertex[0] + origin[0] - low_[0]) / step_,
                    (vertex[1] + origin[1] - low_[1]) / step_, vertex[2] + origin[2]};
    }
    draw(corners);
  }
}

void HeightMap::draw(const std::array<Corner, 3>& corners) {
  const auto& [a, b, c] = corners;
  const double area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
  if (!std::isfinite(area) || area == 0.0) {
    return;
  }
  const auto rows = lines(a[1], b[1], c[1], rows_);
  const auto columns = lines(a[0], b[0], c[0], columns_);
  for (std::ptrdiff_t row = rows.first; row <= rows.last; ++row) {
    for (std::ptrdiff_t column = columns.first; column <= columns.last; ++column) {
      const double x = static_cast<double>(column) - a[0], y = static_cast<double>(row) - a[1];
      const double to_b = (x * (c[1] - a[1]) - (c[0] - a[0]) * y) / area;
      const double to_c = ((b[0] - a[0]) * y - x * (b[1] - a[1])) / area;
      if (to_b < -slack || to_c < -slack || to_b + to_c > 1.0 + slack) {
        continue;
      }
      const auto found = static_cast<float>(a[2] + to_b * (b[2] - a[2]) + to_c * (c[2] - a[2]));
      float& height =
          height_[static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column)];
      if (!(found <= height)) { // true if the height is NaN
        height = found;
      }
    }
  }
}

} // namespace firetwin::tiles
