#pragma once

#include "volume/leaf.hpp"
#include "volume/puffs.hpp"

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::volume {

/// The box of leaves (8^3 voxels) that balls reach, in planes across x. Nothing is kept for its
/// leaves, of which most may be empty.
struct LeafBox {
  openvdb::Coord low;
  openvdb::Coord count;

  /// `reach[i]` is how far ball i matters, m; 0 leaves it out.
  LeafBox(const Puffs& puffs, std::span<const float> reach, double voxel_size);

  std::size_t planes() const { return static_cast<std::size_t>(count.x()); }
  std::size_t leaves_in_plane() const;
  /// First voxel of a leaf of a plane.
  openvdb::Coord origin(std::size_t plane, std::size_t leaf) const;
};

/// Spatial binning of balls to leaves, plane by plane. Balls may reach beyond the box.
class LeafBins {
public:
  LeafBins(const LeafBox& box, const Puffs& puffs, std::span<const float> reach, double voxel_size);

  /// For each leaf of a plane a list of ball numbers, ascending.
  class Plane {
  public:
    Plane(const LeafBins& bins, std::size_t plane);

    std::span<const std::uint32_t> balls(std::size_t leaf) const {
      return {balls_.data() + starts_[leaf], balls_.data() + starts_[leaf + 1]};
    }

  private:
    std::vector<std::size_t> starts_;
    std::vector<std::uint32_t> balls_;
  };

private:
  /// Leaves from and to, both among them.
  struct Range {
    std::array<std::int32_t, 3> low;
    std::array<std::int32_t, 3> high;
  };

  LeafBox box_;
  std::vector<Range> ranges_;           ///< of each ball, inside the box
  std::vector<std::size_t> starts_;     ///< of each plane among the following
  std::vector<std::uint32_t> crossing_; ///< the balls that reach it
};

} // namespace firetwin::volume
