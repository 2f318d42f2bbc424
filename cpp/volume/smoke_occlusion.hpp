#pragma once

#include "volume/voxel_grid.hpp"

#include <span>

namespace firetwin::volume {

/// Viewpoints of the cameras.
struct Viewpoints {
  std::span<const double> places;     ///< (n, 3) m, perspective cameras
  std::span<const double> directions; ///< (m, 3) unit vectors to orthographic cameras
};

/// Occlusion culling of smoke by smoke: voxels behind an optical depth of more than `depth` from
/// every viewpoint are set to 1 in `out`; other values stay.
///
/// Optical depth is found on voxels of four times the size, linear between them. Rays are marched
/// with a step of one of these voxels, through this grid and through `beyond`. Without viewpoints
/// nothing is occluded.
///
/// @param beyond the result for a coarser, larger grid that is drawn as well; may be null
/// @returns extinction of the occluding smoke, 1/m, on voxels of four times the size
/// @throws std::invalid_argument
OwnedVoxelGrid occluded_smoke(const VoxelGrid& extinction, const Viewpoints& eyes, double depth,
                              const VoxelGrid* beyond, std::span<float> out);

} // namespace firetwin::volume
