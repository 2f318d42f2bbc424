#pragma once

#include "volume/ray.hpp"

#include <span>

namespace firetwin::volume {

/// Computes the optical depth along rays up to each ray's distance (n). A ray ends at the optical
/// depth `max_depth`.
void optical_depth(Layers layers, const Rays& rays, std::span<const float> distances, double step,
                   float max_depth, std::span<float> out);

/// Computes the distance along each ray at which the optical depth reaches `depth`, m; infinite if
/// it does not. Distances are ends of segments: at most the length of a block too far.
void opaque_distance(Layers layers, const Rays& rays, double step, float depth,
                     std::span<float> out);

/// Returns the optical depth of one segment; the step is in voxels.
float depth_of(const LayerCrossing& crossing, const Segment& segment, double step);

} // namespace firetwin::volume
