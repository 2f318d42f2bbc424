#pragma once

#include "lod/view_set.hpp"

#include <span>

namespace firetwin::lod {

/// Computes the visibility of n bounding spheres by frustum and occlusion culling. Square tiles of
/// terrain are tested first with all spheres in them, so spheres far from every view cost little.
/// @param centre [3 n] m
/// @param radius [n] m
/// @param out [n] true if any view sees the sphere
/// @throws std::invalid_argument for a negative radius, max_distance or margin
void visible_mask(std::span<const double> centre, std::span<const double> radius,
                  const ViewSet& view_set, const CullOptions& options, std::span<bool> out);

/// Computes the distance of n points from the nearest perspective camera, m; infinite without one.
/// @param place [3 n] m
/// @param out [n] m
void distance(std::span<const double> place, const ViewSet& view_set, std::span<double> out);

} // namespace firetwin::lod
