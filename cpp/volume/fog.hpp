#pragma once

#include "base/vector.hpp"

#include <openvdb/openvdb.h>

#include <string>

namespace firetwin::volume {

/// Makes an empty fog volume with cubic voxels (m); voxel (0, 0, 0) is centred on `origin`.
openvdb::FloatGrid::Ptr fog_grid(const std::string& name, double voxel_size, const Vector& origin,
                                 const std::string& units);

} // namespace firetwin::volume
