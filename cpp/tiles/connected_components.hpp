#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::tiles {

/// Connected components of a mask (4-connectivity).
struct ConnectedComponents {
  std::size_t rows, columns, count;
  std::vector<std::int32_t> number; ///< label of each point; -1 outside the mask
};

ConnectedComponents label_components(std::span<const std::uint8_t> mask, std::size_t rows,
                                     std::size_t columns);

/// Dilates a mask by `by` points along rows and columns (4-connectivity).
std::vector<std::uint8_t> dilate(std::vector<std::uint8_t> mask, std::size_t rows,
                                 std::size_t columns, std::size_t by);

/// Calls a function with each pair of neighbouring points in a row or a column.
template <typename Function>
void for_each_pair(std::size_t rows, std::size_t columns, Function function) {
  for (std::size_t y = 0; y < rows; ++y) {
    for (std::size_t x = 0; x < columns; ++x) {
      const std::size_t k = y * columns + x;
      if (x + 1 < columns) {
        function(k, k + 1);
      }
      if (y + 1 < rows) {
        function(k, k + columns);
      }
    }
  }
}

} // namespace firetwin::tiles
