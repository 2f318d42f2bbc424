#pragma once

#include "base/vector.hpp"
#include "lod/view_set.hpp"
#include "volume/coord.hpp"

namespace firetwin::volume {

/// Frustum and occlusion culling of blocks of voxels.
class LeafCulling {
public:
  /// @param view_set null disables culling
  /// @param origin centre of voxel (0, 0, 0), m
  LeafCulling(const lod::ViewSet* view_set, double voxel_size, const Vector& origin)
      : view_set_(view_set), voxel_size_(voxel_size), origin_(origin) {}

  /// Returns whether a cube of `side` voxels may be visible, or cast a visible shadow. The cube's
  /// bounding sphere is enlarged by 300 m, for noise and for light that smoke scatters.
  bool is_visible(const Coord& lowest, int side) const;

private:
  const lod::ViewSet* view_set_;
  double voxel_size_;
  Vector origin_;
};

} // namespace firetwin::volume
