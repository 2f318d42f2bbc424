#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::tiles {

/// Connected parts of a mask, by sides.
struct ConnectedComponents {
  std::size_t rows, columns, count;
  std::vector<std::int32_t> number; ///< of each point; -1 outside of the mask
};

ConnectedComponents label_components(std::span<const std::uint8_t> mask, std::size_t rows,
                                     std::size_t columns);

/// The mask widened by a number of points along rows and columns.
std::vector<std::uint8_t> dilate(std::vector<std::uint8_t> mask, std::size_t rows,
                                 std::size_t columns, std::size_t by);

/// Calls a function with each pair of points that are neighbours in a row or a column.
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
