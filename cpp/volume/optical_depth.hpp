#pragma once

#include "volume/ray.hpp"

#include <span>

namespace firetwin::volume {

/// Optical depth of rays up to each one's distance (n). A ray ends at the optical depth `enough`.
void optical_depth(Layers layers, const Rays& rays, std::span<const float> distances, double step,
                   float enough, std::span<float> out);

/// Optical depth of one segment, with a step length in voxels.
float depth_of(const Crossing& crossing, const Segment& segment, double step);

} // namespace firetwin::volume
