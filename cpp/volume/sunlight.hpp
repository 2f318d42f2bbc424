#pragma once

#include "base/vector.hpp"
#include "volume/voxel_grid.hpp"

#include <array>
#include <cstddef>
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

/// Number of directions that represent the sky.
constexpr std::size_t sky_directions = 5;
using SkyDepths = std::array<OwnedVoxelGrid, sky_directions>;

/// Computes the optical depths from voxel centres in five upward directions, each representing a
/// fifth of the sky.
/// @param beyond the result for a larger, coarser grid, added where a ray leaves this one; may be
/// null
SkyDepths sky_depths(const VoxelGrid& smoke, const SkyDepths* beyond);

/// Averages exp(-part * optical depth) over the directions.
std::vector<float> sky_light(const SkyDepths& depths, double part);

} // namespace firetwin::volume
