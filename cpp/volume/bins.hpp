#pragma once

#include "volume/leaf.hpp"
#include "volume/puffs.hpp"

#include <openvdb/openvdb.h>

#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::volume {

/// The box of leaves (8^3 voxels) that balls reach.
struct LeafBox {
  openvdb::Coord low;
  openvdb::Coord count;

  /// `reach[i]` is how far ball i matters, m; 0 leaves it out.
  LeafBox(const Puffs& puffs, std::span<const float> reach, double voxel_size);

  std::size_t size() const;
  /// First voxel of a leaf.
  openvdb::Coord origin(std::size_t leaf) const;
};

/// Which balls reach which leaf of a box: lists of ball numbers, ascending. Balls may reach beyond
/// the box.
class Bins {
public:
  Bins(const LeafBox& box, const Puffs& puffs, std::span<const float> reach, double voxel_size);

  std::span<const std::uint32_t> balls(std::size_t leaf) const {
    return {balls_.data() + starts_[leaf], balls_.data() + starts_[leaf + 1]};
  }

private:
  std::vector<std::size_t> starts_;
  std::vector<std::uint32_t> balls_;
};

} // namespace firetwin::volume
