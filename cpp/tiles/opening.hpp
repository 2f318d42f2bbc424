#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::tiles {

/// Grey-scale opening: the minimum in a square window, then the maximum of the result. Removes
/// objects narrower than the window and preserves planes.
/// @param height rows x columns; NaN is ignored and preserved
/// @param radius half width of the window without its centre, cells
std::vector<float> morphological_opening(std::span<const float> height, std::size_t rows,
                                         std::size_t columns, std::size_t radius);

} // namespace firetwin::tiles
