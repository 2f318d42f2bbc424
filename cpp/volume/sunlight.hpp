#pragma once

#include "base/vector.hpp"
#include "volume/voxel_grid.hpp"

#include <vector>

namespace firetwin::volume {

/// Computes the optical depth from voxel centres to a distant light.
///
/// Sweeps slices across the axis nearest to the light's direction, from the lit side: a voxel takes
/// the depth where its ray crosses the previous slice, linear between that slice's voxels, plus the
/// trapezoidal rule in between. Shadow edges therefore widen by about half a voxel times the square
/// root of the number of slices.
///
/// @param direction unit vector to the light
/// @param beyond optical depths of a larger, coarser grid, added where a ray leaves this one; may
/// be null
/// @throws std::invalid_argument
std::vector<float> optical_depth(const VoxelGrid& smoke, const Vector& direction,
                                 const VoxelGrid* beyond);

/// Averages exp(-part * optical depth) over five upward directions, each representing a fifth of
/// the sky.
std::vector<float> sky_light(const VoxelGrid& smoke, double part);

} // namespace firetwin::volume
