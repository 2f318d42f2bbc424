#pragma once

#include "volume/leaf.hpp"
#include "volume/puffs.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::volume {

/// Bounding box, in leaves (8^3 voxels), of the balls' range, as planes across x. It stores nothing
/// per leaf, as most may be empty.
struct LeafBox {
  Coord low;
  Coord count;

  /// @param reach range of influence of each ball, m; 0 ignores the ball
  LeafBox(const Puffs& puffs, std::span<const float> reach, double voxel_size);

  std::size_t planes() const { return static_cast<std::size_t>(count.x()); }
  std::size_t leaves_in_plane() const;
  /// Returns the first voxel of a leaf in a plane.
  Coord origin(std::size_t plane, std::size_t leaf) const;
};

/// Spatial binning of balls to leaves, plane by plane. Balls may extend beyond the box.
class LeafBins {
public:
  LeafBins(const LeafBox& box, const Puffs& puffs, std::span<const float> reach, double voxel_size);

  /// Ball numbers for each leaf of a plane, ascending.
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
  /// First and last leaf, inclusive.
  struct Range {
    std::array<std::int32_t, 3> low;
    std::array<std::int32_t, 3> high;
  };

  LeafBox box_;
  std::vector<Range> ranges_;           ///< by ball, clipped to the box
  std::vector<std::size_t> starts_;     ///< start of each plane in `crossing_`
  std::vector<std::uint32_t> crossing_; ///< balls that reach a plane
};

} // namespace firetwin::volume
