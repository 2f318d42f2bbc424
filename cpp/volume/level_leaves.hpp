#pragma once

#include "geo/local_frame.hpp"
#include "volume/levels.hpp"

#include <vector>

namespace firetwin::volume {

/// Finds the first voxels of all leaves that smoke may reach, sorted by x, y and z. Leaves and
/// levels without smoke use no memory.
/// @throws Error if voxels are far too small
std::vector<Coord> reached_leaves(const geo::LocalFrame& frame, const Levels& levels,
                                  double voxel_size);

} // namespace firetwin::volume
