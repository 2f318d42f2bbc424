#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::lod {

/// Indices of the `budget` positions nearest to any camera, nearest first, ties by index. Positions
/// whose distance is NaN to every camera come last; a camera with NaN sees nothing.
/// @param position [3 n] m
/// @param camera [3 m] m
std::vector<std::int64_t> select(std::span<const double> position, std::span<const double> camera,
                                 std::size_t budget);

} // namespace firetwin::lod
