#pragma once

#include "geo/height_field.hpp"
#include "lod/frustum.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::lod {

/// How far every view of a path reaches.
struct ViewLimits {
  double near;                    ///< m
  double far;                     ///< m, may be infinite
  double margin;                  ///< added to every radius, m
  const geo::HeightField* ground; ///< hides what lies behind it; may be null
};

/// First and last view of a path that may see each ball [2 n]; -1, -1 where none does.
///
/// Conservative: no ball that a view sees is left out (frustum.hpp and occlusion.hpp say what may
/// be kept in vain). A view with NaN sees nothing, and a ball with NaN is never seen.
/// @param centre [3 n] m
/// @param radius [n] m
/// @throws std::invalid_argument for angles outside 0 .. pi and for negative radii or margins.
std::vector<std::int32_t> seen(std::span<const double> centre, std::span<const double> radius,
                               std::span<const View> path, const ViewLimits& limits);

} // namespace firetwin::lod
