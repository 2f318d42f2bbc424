#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::lod {

/// Distance budget: indices of the `budget` positions nearest to any camera. The order is nearest
/// first, ties by index. Positions with a NaN distance to every camera come last. A camera with a
/// NaN is ignored.
/// @param position [3 n] m
/// @param camera [3 m] m
std::vector<std::int64_t> select_nearest(std::span<const double> position,
                                         std::span<const double> camera, std::size_t budget);

} // namespace firetwin::lod
