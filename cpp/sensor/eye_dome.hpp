#pragma once

#include <cstddef>
#include <span>

namespace firetwin::sensor {

/// Eye-dome lighting (C. Boucheny 2009, "Interactive scientific visualization of large datasets:
/// towards a perceptive-based approach"): a pixel is darker the farther it is behind its eight
/// neighbours at `radius` pixels. shade = exp(-strength s), where s is the mean of max(0,
/// log2(depth) - log2(neighbour's depth)); neighbours outside the image have the pixel's depth.
/// Ratios of depth shade near and far edges equally. NaN and depths above 1e9 m, such as the sky,
/// are set to 1e9 m.
/// @param depth [height width] m, above 0 @param shade [height width] result, 0..1
/// @throws std::invalid_argument unless strength >= 0 is finite and radius is above 0
void eye_dome(std::span<const float> depth, std::size_t height, std::size_t width, double strength,
              std::size_t radius, std::span<float> shade);

} // namespace firetwin::sensor
