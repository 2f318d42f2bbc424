#pragma once

#include "puffs.hpp"

#include <openvdb/openvdb.h>

#include <cstdint>
#include <span>
#include <vector>

namespace firetwin {

/// Which balls reach which 8^3 leaf: lists of ball numbers per leaf, for a box of leaves.
class Bins {
public:
  static constexpr int kLeaf = 8;

  /// `reach[i]` is how far ball i matters, m; 0 leaves it out.
  Bins(const Puffs& puffs, const std::vector<float>& reach, double voxel_size);

  std::size_t size() const { return starts_.empty() ? 0 : starts_.size() - 1; }
  std::span<const std::uint32_t> balls(std::size_t leaf) const {
    return {balls_.data() + starts_[leaf], balls_.data() + starts_[leaf + 1]};
  }
  /// First voxel of a leaf.
  openvdb::Coord origin(std::size_t leaf) const;

private:
  openvdb::Coord low_;
  openvdb::Coord count_;
  std::vector<std::size_t> starts_;
  std::vector<std::uint32_t> balls_;
};

} // namespace firetwin
