#pragma once

#include "base/vector.hpp"
#include "lod/sight.hpp"

#include <openvdb/openvdb.h>

namespace firetwin::volume {

/// Which blocks of voxels the cameras of a moment have use for.
class Seen {
public:
  /// @param sight null: every block counts
  /// @param origin centre of voxel (0, 0, 0), m
  Seen(const lod::Sight* sight, double voxel_size, const Vector& origin)
      : sight_(sight), voxel_size_(voxel_size), origin_(origin) {}

  /// Whether a cube of `side` voxels counts, with 300 m round it: noise, and light that smoke
  /// passes on.
  bool counts(const openvdb::Coord& lowest, int side) const;

private:
  const lod::Sight* sight_;
  double voxel_size_;
  Vector origin_;
};

} // namespace firetwin::volume
