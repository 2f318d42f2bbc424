#pragma once

#include "base/vector.hpp"
#include "volume/brick.hpp"

#include <array>
#include <span>

namespace firetwin::volume {

struct Light {
  std::span<float> sun; ///< exp(-part of the optical depth)
  std::span<float> sky; ///< mean of the same over five ways up, each for a fifth of the sky
};

/// Light in smoke, 1 where it is clear; only where `extinction` (1/m) is above zero in the voxel or
/// one of the 26 around it, which is all that is needed to interpolate it: elsewhere values stay.
///
/// Optical depth to the sun is found on voxels of twice the size. Slices across the axis that the
/// light comes most nearly along are gone through from the lit side on: a voxel has the depth found
/// where its way to the light crosses the slice before, linear between that slice's voxels, and
/// what lies between by the trapezoid rule. So shadows widen by about half a voxel times the root
/// of the number of slices. The first voxels of the way are marched one by one. The sky's light is
/// found on voxels of four times the size, linear between.
///
/// @param direction unit vector that the sun's light comes from
/// @param beyond optical depths of a larger brick, counted where a way leaves this one; may be null
/// @param parts of the optical depth that count, for the sun and for the sky
/// @returns optical depths to the sun, on voxels of twice the size
/// @throws std::invalid_argument
OwnBrick lit(const Brick& extinction, const Vector& direction, const Brick* beyond,
             std::array<double, 2> parts, const Light& light);

} // namespace firetwin::volume
