#pragma once

#include "base/vector.hpp"
#include "volume/voxel_grid.hpp"

#include <vector>

namespace firetwin::volume {

/// Optical depth from the middles of voxels to a light far away.
///
/// Slices across the axis that the light comes most nearly along are gone through from the lit side
/// on: a voxel has the depth found where its way to the light crosses the slice before, linear
/// between that slice's voxels, and what lies between by the trapezoid rule. So shadows widen by
/// about half a voxel times the root of the number of slices.
///
/// @param direction unit vector that the light comes from
/// @param beyond optical depths of a larger brick, counted where a way leaves this one; may be null
/// @throws std::invalid_argument
std::vector<float> optical_depth(const VoxelGrid& smoke, const Vector& direction,
                                 const VoxelGrid* beyond);

/// Mean of exp(-part * optical depth) over five ways up, each for a fifth of the sky.
std::vector<float> sky_light(const VoxelGrid& smoke, double part);

} // namespace firetwin::volume
