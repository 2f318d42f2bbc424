#pragma once

#include "flames/flames.hpp"
#include "volume/ray.hpp"

#include <span>

namespace firetwin::volume {

/// Computes the distance within which flames emit half of the red light that a ray sees up to
/// `farthest`, m, and that light: two values for each ray; 0 without flames. Air and smoke are
/// clear.
void flame_distance(const flames::FlameVolume& flames, const Rays& rays, float farthest,
                    std::span<float> out);

} // namespace firetwin::volume
