#pragma once

#include "volume/voxel_grid.hpp"

#include <span>

namespace firetwin::volume {

/// Viewpoints of the cameras.
struct Viewpoints {
  std::span<const double> places;     ///< (n, 3) m, perspective cameras
  std::span<const double> directions; ///< (m, 3) unit vectors towards orthographic cameras
};

/// Occlusion culling of smoke by smoke: sets `out` to 1 in voxels behind an optical depth of more
/// than `depth` from every viewpoint; other values are unchanged.
///
/// Optical depth is computed on voxels of four times the size and interpolated linearly. Rays are
/// marched with steps of one such voxel, through this grid and through `beyond`. Without viewpoints
/// nothing is occluded.
///
/// @param beyond result for a coarser, larger grid that is drawn as well; may be null
/// @returns extinction of the occluding smoke, 1/m, on voxels of four times the size
/// @throws std::invalid_argument
OwnedVoxelGrid occluded_smoke(const VoxelGrid& extinction, const Viewpoints& eyes, double depth,
                              const VoxelGrid* beyond, std::span<float> out);

} // namespace firetwin::volume
