#pragma once

#include "volume/leaf.hpp"
#include "volume/puffs.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::volume {

constexpr float depth_inside = 300.0F;  ///< m of depth at which density reaches 1
constexpr float depth_outside = 150.0F; ///< m outside the balls where voxels end

/// Depth in the union of balls, leaf by leaf. Keeps its memory from leaf to leaf: one for each
/// thread.
///
/// A block of voxels is measured at its centre: d changes by at most a metre per metre, so a ball
/// whose depth there is behind the deepest by more than the block's diagonal is deepest in none of
/// its voxels. What is left over goes on to the block's eight parts, and in blocks of 2^3 to every
/// voxel.
class DepthMeter {
public:
  /// Depth (m, positive inside, at least -depth_outside) and radius of the deepest ball. Only the
  /// blocks of 2^3 voxels with a bit in `wanted` (z fastest) are measured; the others keep
  /// -depth_outside and 0. Depths over depth_inside may be too small, but never smaller than that.
  void measure(const Puffs& puffs, std::span<const std::uint32_t> balls,
               const std::array<float, 3>& corner, float voxel_size, std::uint64_t wanted,
               LeafValues& depth, LeafValues& radius);

private:
  /// Balls side by side, filled up to whole lanes with balls that are nowhere.
  struct Balls {
    std::vector<float> x, y, z, radius;
    std::size_t count = 0;

    void reserve(std::size_t most);
    void add(float ball_x, float ball_y, float ball_z, float ball_radius);
    /// Takes over the balls that are at least so deep.
    void keep(const Balls& from, std::span<const float> depths, float least);
    void fill_up();
  };
  struct Block {
    std::array<std::size_t, 3> origin; ///< its first voxel in the leaf
    std::size_t side;                  ///< voxels
    std::size_t round;                 ///< how often balls were left out
  };

  void refine(const Block& block, std::uint64_t wanted);
  void fill(const Block& block, float depth, float radius);
  void measure_voxels(const Block& block, const Balls& balls);
  std::array<float, 3> place(const Block& block, float offset) const;

  std::array<Balls, 4> balls_; ///< of the leaf, and what is left after 8^3, 4^3 and 2^3
  std::vector<float> depths_;
  std::array<float, 3> corner_{};
  float voxel_ = 0.0F;
  LeafValues* depth_ = nullptr;
  LeafValues* radius_ = nullptr;
};

} // namespace firetwin::volume
