#include "volume/seen.hpp"

#include <cmath>

namespace firetwin::volume {
namespace {

constexpr double margin = 300.0; // m

} // namespace

bool Seen::counts(const openvdb::Coord& lowest, int side) const {
  if (sight_ == nullptr) {
    return true;
  }
  const double middle = 0.5 * (side - 1);
  const double radius = 0.5 * std::sqrt(3.0) * side * voxel_size_;
  const lod::Ball block{{origin_[0] + (lowest.x() + middle) * voxel_size_,
                         origin_[1] + (lowest.y() + middle) * voxel_size_,
                         origin_[2] + (lowest.z() + middle) * voxel_size_},
                        radius + margin};
  return sight_->counts(block, {.shadows = true});
}

} // namespace firetwin::volume
