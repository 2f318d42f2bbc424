#pragma once

#include "geo/local_frame.hpp"
#include "volume/levels.hpp"

#include <openvdb/openvdb.h>

#include <vector>

namespace firetwin::volume {

/// First voxels of the leaves that smoke may reach, in the order of their x, y and z. Nothing is
/// kept for leaves and levels without smoke.
/// @throws Error when voxels are far too small
std::vector<openvdb::Coord> reached_leaves(const geo::LocalFrame& frame, const Levels& levels,
                                           double voxel_size);

} // namespace firetwin::volume
