#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::tiles {

/// The highest surface of triangles above points of an even grid.
class HeightMap {
public:
  /// Points at low + (column, row) * step, m. @throws std::invalid_argument where step is not above
  /// 0
  HeightMap(std::array<double, 2> low, double step, std::size_t rows, std::size_t columns);

  /// Raises the heights to triangles (t x 3 rows of n x 3 positions about an origin). Upright ones
  /// count for nothing. @throws std::out_of_range where a vertex does not exist
  void add(std::span<const float> position, std::array<double, 3> origin,
           std::span<const std::uint32_t> triangle);

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  /// rows x columns, m; NaN where there is no triangle.
  const std::vector<float>& height() const { return height_; }

private:
  using Corner = std::array<double, 3>; ///< column and row, fractional, and height

  void draw(const std::array<Corner, 3>& corners);

  std::array<double, 2> low_;
  double step_;
  std::size_t rows_, columns_;
  std::vector<float> height_;
};

} // namespace firetwin::tiles
