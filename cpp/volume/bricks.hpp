#pragma once

#include "base/vector.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::volume {

/// Smoke and the light in it on voxels of one size, only where there is smoke: what rays are
/// marched through.
///
/// Blocks of 8^3 cells, each with the 9^3 voxels at its cells' corners, so that what is between
/// them is found within one block. A voxel is eight half floats, one after the other.
class Bricks {
public:
  static constexpr std::int64_t side = 8; ///< cells
  static constexpr std::int64_t wide = side + 1;
  static constexpr std::size_t channels = 8; ///< of which three are spare
  static constexpr std::size_t block_size = wide * wide * wide * channels;
  static constexpr float thinnest = 2.5e-5F; ///< 1/m; a block without more counts as clear

  /// Of a voxel, as they lie in a block.
  struct Fields {
    std::span<const float> density; ///< extinction, 1/m
    std::span<const float> fresh;   ///< 1 where smoke is young, 0 where it is old
    std::span<const float> sun;     ///< fourth root of the part of the sun's light that comes there
    std::span<const float> sky;     ///< part of the sky's light
    std::span<const float> glow;    ///< light of flames; may be empty
  };

  /// @param shape voxels along x, y and z; z runs fastest
  /// @param origin of the first voxel's middle, m
  /// @throws std::invalid_argument
  Bricks(const Fields& fields, const std::array<std::int64_t, 3>& shape, double voxel,
         const Vector& origin);

  double voxel() const { return voxel_; }
  const Vector& origin() const { return origin_; }
  const std::array<std::int64_t, 3>& shape() const { return shape_; }
  const std::array<std::int64_t, 3>& blocks() const { return blocks_; }
  std::size_t used() const { return pool_.size() / block_size; }
  std::size_t bytes() const { return pool_.size() * sizeof(std::uint16_t); }

  /// A block's voxels, or null where it is clear.
  const std::uint16_t* block(std::int64_t i, std::int64_t j, std::int64_t k) const {
    const auto at = static_cast<std::size_t>((i * blocks_[1] + j) * blocks_[2] + k);
    return index_[at] < 0 ? nullptr
                          : pool_.data() + static_cast<std::size_t>(index_[at]) * block_size;
  }

private:
  std::vector<std::uint8_t> smoky(std::span<const float> density) const;
  void pack(const Fields& fields, std::int64_t i, std::int64_t j, std::int64_t k,
            std::uint16_t* out) const;

  std::array<std::int64_t, 3> shape_, blocks_;
  double voxel_;
  Vector origin_;
  std::vector<std::int32_t> index_; ///< of each block in the pool, -1: clear
  std::vector<std::uint16_t> pool_;
};

} // namespace firetwin::volume
