#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::tiles {

/// Grey-scale opening: the lowest height within a square window, then the highest of these. It
/// takes away what is narrower than the window, and leaves planes as they are.
/// @param height rows x columns; NaN counts for nothing and stays
/// @param radius cells from the middle of the window to its sides
std::vector<float> morphological_opening(std::span<const float> height, std::size_t rows,
                                         std::size_t columns, std::size_t radius);

} // namespace firetwin::tiles
