#pragma once

#include "base/vector.hpp"
#include "volume/lit_smoke.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace firetwin::volume {

/// The share of smoke that is visible. All of the smoke attenuates light.
struct VisibleShare {
  std::span<const double> share; ///< [nx][ny] factor on the density, 0 to 1
  float min_extinction = 0.0F;   ///< 1/m; smoke below it is set to clear

  float density(float all, std::size_t column) const {
    const auto left = static_cast<float>(static_cast<double>(all) * share[column]);
    return left < min_extinction ? 0.0F : left;
  }
};

/// Sparse voxel grid of smoke and light for ray marching.
///
/// A block has 8^3 cells and the 9^3 voxels at their corners, so that interpolation needs one block
/// only. A voxel is eight consecutive half floats.
class Bricks {
public:
  static constexpr std::int64_t side = 8; ///< cells
  static constexpr std::int64_t wide = side + 1;
  static constexpr std::size_t channels = 8;
  static constexpr std::size_t block_size = wide * wide * wide * channels;
  static constexpr float min_extinction = 2.5e-5F; ///< 1/m; a block is stored if a voxel exceeds it

  /// Fields of the voxels, in the memory layout of a block.
  struct Fields {
    std::span<const float> density; ///< extinction, 1/m
    std::span<const float> fresh;   ///< 1 in young smoke, 0 in old smoke
    std::span<const float> sun;     ///< fourth root of the sunlight's transmittance
    std::span<const float> sky;     ///< transmittance of skylight
    std::span<const float> glow;    ///< light of flames; may be empty
    /// Position in the outline, 0 (outer side) to 1 (inner side); empty: no outline.
    std::span<const float> edge;
  };

  /// @param shape voxels along x, y and z; z runs fastest
  /// @param origin centre of the first voxel, m
  /// @throws std::invalid_argument
  Bricks(const Fields& fields, const std::array<std::int64_t, 3>& shape, double voxel,
         const Vector& origin);

  /// Packs smoke that is already sparse, block by block.
  /// @throws std::invalid_argument
  Bricks(const LitSmoke& smoke, const VisibleShare& visible);

  double voxel() const { return voxel_; }
  const Vector& origin() const { return origin_; }
  const std::array<std::int64_t, 3>& shape() const { return shape_; }
  const std::array<std::int64_t, 3>& blocks() const { return blocks_; }
  std::size_t used() const { return used_; }
  std::size_t bytes() const { return used_ * block_size * sizeof(std::uint16_t); }

  /// Returns a block's voxels, or null if it is clear.
  const std::uint16_t* block(std::int64_t i, std::int64_t j, std::int64_t k) const {
    const auto at = static_cast<std::size_t>((i * blocks_[1] + j) * blocks_[2] + k);
    return index_[at] < 0 ? nullptr
                          : pool_.get() + static_cast<std::size_t>(index_[at]) * block_size;
  }

  /// Noise below the voxel; null: none.
  const NoiseFrame* noise() const { return noise_.get(); }

  /// Packs density, fresh, sun, sky and glow of a voxel; its share inside the outline, 0 to 1, its
  /// position in the outline as in `SparseSmoke`, and its density without an outline.
  static void write(const std::array<float, channels>& voxel, std::uint16_t* out);

private:
  using Place = std::array<std::int64_t, 3>;

  /// Finds blocks with smoke by `has_smoke(place)`, and fills them; `filler()` makes the function
  /// `fill(place, out)` for each column of blocks.
  template <class HasSmoke, class Filler>
  void build(const HasSmoke& has_smoke, const Filler& filler);
  bool has_smoke(std::span<const float> density, const Place& block) const;
  void pack(const Fields& fields, const Place& block, std::uint16_t* out) const;

  std::array<std::int64_t, 3> shape_, blocks_{};
  double voxel_;
  Vector origin_;
  std::vector<std::int32_t> index_; ///< of each block in the pool; -1: clear
  std::size_t used_ = 0;
  std::shared_ptr<const NoiseFrame> noise_;
  std::unique_ptr<std::uint16_t[]> pool_;
};

} // namespace firetwin::volume
