#pragma once

#include "volume/leaf.hpp"
#include "volume/puffs.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::volume {

constexpr float depth_inside = 300.0F;  ///< m of depth at which density reaches 1
constexpr float depth_outside = 150.0F; ///< m outside the balls up to which voxels are active

/// Depth in a union of balls, leaf by leaf. Use one object per thread: it reuses its memory.
///
/// Depth changes by at most 1 m per metre. At the centre of a block, a ball whose depth is less
/// than the largest by more than the block's diagonal is nowhere the deepest in that block, and is
/// dropped. The remaining balls go to the block's eight children, and in blocks of 2^3 voxels to
/// each voxel.
class DepthMeter {
public:
  /// Computes the depth (m, positive inside, at least -depth_outside) and the radius of the deepest
  /// ball. Only blocks of 2^3 voxels whose bit in `wanted` is set (z fastest) are computed; the
  /// others get -depth_outside and 0. Depths over depth_inside may be underestimated, but not below
  /// depth_inside.
  void measure(const Puffs& puffs, std::span<const std::uint32_t> balls,
               const std::array<float, 3>& corner, float voxel_size, std::uint64_t wanted,
               LeafValues& depth, LeafValues& radius);

private:
  /// Balls as a structure of arrays, padded to full lanes with balls at infinity.
  struct Balls {
    std::vector<float> x, y, z, radius;
    std::size_t count = 0;

    void reserve(std::size_t most);
    void add(float ball_x, float ball_y, float ball_z, float ball_radius);
    /// Copies the balls whose depth is at least `least`.
    void select(const Balls& from, std::span<const float> depths, float least);
    void fill_up();
  };
  struct Block {
    std::array<std::size_t, 3> origin; ///< first voxel in the leaf
    std::size_t side;                  ///< voxels
    std::size_t round;                 ///< level of subdivision
  };

  void refine(const Block& block, std::uint64_t wanted);
  void fill(const Block& block, float depth, float radius);
  void measure_voxels(const Block& block, const Balls& balls);
  std::array<float, 3> point(const Block& block, float offset) const;

  std::array<Balls, 4> balls_; ///< of the leaf, and those that remain after 8^3, 4^3 and 2^3
  std::vector<float> depths_;
  std::array<float, 3> corner_{};
  float voxel_ = 0.0F;
  LeafValues* depth_ = nullptr;
  LeafValues* radius_ = nullptr;
};

} // namespace firetwin::volume
