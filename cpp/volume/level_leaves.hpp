#pragma once

#include "geo/local_frame.hpp"
#include "volume/levels.hpp"

#include <openvdb/openvdb.h>

#include <span>
#include <vector>

namespace firetwin::volume {

/// First voxels of the leaves that cells with smoke may reach, in the order of their x, y and z.
/// @param smoke [nz ny nx] kg/m3 without gaps
/// @throws Error when voxels are far too small
std::vector<openvdb::Coord> reached_leaves(const geo::LocalFrame& frame, const Levels& levels,
                                           std::span<const float> smoke, double voxel_size);

} // namespace firetwin::volume
