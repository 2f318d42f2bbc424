#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::tiles {

/// Maximum height of triangles at the points of a regular grid.
class HeightMap {
public:
  /// Grid points are at low + (column, row) * step, m. @throws std::invalid_argument unless step is
  /// above 0
  HeightMap(std::array<double, 2> low, double step, std::size_t rows, std::size_t columns);

  /// Raises the heights to triangles (t x 3 vertex indices into n x 3 positions relative to an
  /// origin). Vertical triangles are ignored. @throws std::out_of_range if a vertex does not exist
  void add(std::span<const float> position, std::array<double, 3> origin,
           std::span<const std::uint32_t> triangle);

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  /// rows x columns, m; NaN without a triangle.
  const std::vector<float>& height() const { return height_; }

private:
  using Corner = std::array<double, 3>; ///< fractional column, fractional row, height

  void draw(const std::array<Corner, 3>& corners);

  std::array<double, 2> low_;
  double step_;
  std::size_t rows_, columns_;
  std::vector<float> height_;
};

} // namespace firetwin::tiles
