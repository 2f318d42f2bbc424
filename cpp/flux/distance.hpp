#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::flux {

/// Distances, in cells, to the nearest marked cell of a grid.
class Distance {
public:
  /// @param marked [rows columns], non-zero where marked
  Distance(std::span<const std::uint8_t> marked, std::size_t rows, std::size_t columns);

  /// Exact Euclidean distance from (y, x); infinity when no cell is marked.
  double from(std::size_t y, std::size_t x) const;

private:
  std::size_t columns_;
  std::vector<double> vertical_; ///< to the nearest marked cell of the same column
};

} // namespace firetwin::flux
