#pragma once

#include "base/vector.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::volume {

/// Values (nx, ny, nz) in the middles of cubic voxels, z running fastest.
struct Brick {
  std::span<const float> values;
  std::array<std::int64_t, 3> shape;
  double voxel;  ///< m
  Vector origin; ///< centre of the first voxel, m
};

/// Optical depth from the middles of voxels to a light far away.
///
/// Slices across the axis that the light comes most nearly along are gone through from the lit side
/// on: a voxel has the depth found where its way to the light crosses the slice before, linear
/// between that slice's voxels, and what lies between by the trapezoid rule. So shadows widen by
/// about half a voxel times the root of the number of slices.
///
/// @param extinction 1/m
/// @param direction unit vector that the light comes from
/// @param beyond optical depths of a larger brick, counted where a way leaves this one; may be null
/// @param depth as many as voxels
void sun_depth(const Brick& extinction, const Vector& direction, const Brick* beyond,
               std::span<float> depth);

struct Light {
  std::span<float> sun; ///< exp(-part of the optical depth)
  std::span<float> sky; ///< mean of the same over five ways up, each for a fifth of the sky
};

/// Light in smoke, 1 where it is clear; only where `extinction` is above zero in the voxel or one
/// of the 26 around it, which is all that is needed to interpolate it: elsewhere values stay.
///
/// The sun's way is marched voxel by voxel as far as `fine_steps`; from there on its depth is
/// `depth`'s, which was found on voxels of twice the size. The sky's light is found on voxels of
/// four times the size, linear between.
void lit(const Brick& extinction, const Vector& direction, const Brick& depth,
         std::array<double, 2> parts, const Light& light);

/// The same smoke in voxels of twice the size, in `mean`; what lies beyond the brick is clear.
Brick halved(const Brick& smoke, std::vector<float>& mean);

} // namespace firetwin::volume
