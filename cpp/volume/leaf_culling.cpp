#include "volume/leaf_culling.hpp"

#include <cmath>

namespace firetwin::volume {
namespace {

constexpr double margin = 300.0; // m

} // namespace

bool LeafCulling::is_visible(const Coord& lowest, int side) const {
  if (view_set_ == nullptr) {
    return true;
  }
  const double middle = 0.5 * (side - 1);
  const double radius = 0.5 * std::sqrt(3.0) * side * voxel_size_;
  const lod::BoundingSphere block{{origin_[0] + (lowest.x() + middle) * voxel_size_,
                                   origin_[1] + (lowest.y() + middle) * voxel_size_,
                                   origin_[2] + (lowest.z() + middle) * voxel_size_},
                                  radius + margin};
  return view_set_->is_visible(block, {.shadows = true});
}

} // namespace firetwin::volume
