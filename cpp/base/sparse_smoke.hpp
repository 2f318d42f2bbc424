#pragma once

#include "base/vector.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace firetwin {

/// Coordinates of the noise that continues below the voxel, which travel with the air: values at
/// the corners of blocks, for two phases that are blended.
struct NoiseFrame {
  static constexpr std::size_t phases = 2, parts = 3 * phases;
  static constexpr double finer = 0.47;    ///< wavelength of an octave over the one before
  static constexpr float roughness = 0.7F; ///< amplitude of an octave over the one before

  float size = 0.0F;                   ///< wavelength of the largest octave not painted, m
  float share = 0.0F;                  ///< its amplitude in the unit of `edge`
  std::array<float, phases> weights{}; ///< their squares sum to 1
  std::array<std::uint32_t, phases> seeds{};
  std::array<std::int64_t, 3> corners{};        ///< number along x, y and z
  std::vector<std::array<float, parts>> places; ///< m; z runs fastest

  const std::array<float, parts>& at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return places[static_cast<std::size_t>((i * corners[1] + j) * corners[2] + k)];
  }
};

/// Sparse voxel grid of smoke: blocks of 8^3 voxels; clear blocks are not stored. Blocks and voxels
/// are ordered with x slowest and z fastest.
class SparseSmoke {
public:
  using Index = std::int64_t;
  using Place = std::array<Index, 3>;
  enum Field : std::size_t {
    density, ///< extinction, 1/m
    fresh,   ///< freshness: 1 for young smoke, 0 for old or no smoke
    edge, ///< position in the outline of billows: 0 far outside, 1 where smoke begins, 2 where it
          ///< is complete, 3 far inside
    veil, ///< part of the extinction without an outline, 1/m
    glow  ///< light of flames; optional
  };
  static constexpr Index side = 8;
  static constexpr std::size_t block_size = side * side * side;

  /// Creates a clear grid.
  /// @param shape voxels along x, y and z
  /// @param origin centre of the first voxel, m
  SparseSmoke(const Place& shape, double voxel, const Vector& origin, bool glows);

  const Place& shape() const { return shape_; }
  const Place& blocks() const { return blocks_; }
  double voxel() const { return voxel_; }
  const Vector& origin() const { return origin_; }
  /// Noise below the voxel; null: none.
  const std::shared_ptr<const NoiseFrame>& noise() const { return noise_; }
  void set_noise(std::shared_ptr<const NoiseFrame> noise) { noise_ = std::move(noise); }
  bool glows() const { return fields_ > glow; }
  /// Number of values of a block; fields are stored one after the other.
  std::size_t values() const { return fields_ * block_size; }
  std::size_t used() const;

  /// Values of a field in a block; null for clear blocks and blocks outside the grid.
  const float* block(const Place& at, Field field) const {
    for (std::size_t axis = 0; axis < at.size(); ++axis) {
      if (at[axis] < 0 || at[axis] >= blocks_[axis]) {
        return nullptr;
      }
    }
    const float* found = pool_[number(at)].get();
    return found == nullptr ? nullptr : found + field * block_size;
  }
  float* block(const Place& at, Field field) {
    return const_cast<float*>(std::as_const(*this).block(at, field));
  }
  /// Stores the values of a block. Thread-safe for distinct blocks.
  void keep(const Place& at, std::span<const float> values);

  /// Stores the blocks of a dense density array that are not clear.
  void keep_all(std::span<const float> dense);

  /// Copies a block with its surroundings to out[(x * count + y) * 3 * side]: `count` columns along
  /// x and y that start `before` voxels before the block; along z, the block and its two
  /// neighbours. Clear voxels and voxels outside the grid are 0.
  void gather(Field field, const Place& block, Index before, Index count, float* out) const;
  /// Writes `change(value, column)` of all stored voxels to a dense array of zeros. Columns are
  /// numbered along x, then y.
  template <class Change>
  void spread(Field field, std::span<float> dense, const Change& change) const {
    check_dense(dense.size());
    each_row([&](const Row& row) {
      const float* from = pool_[row.block].get() + field * block_size + row.within;
      for (std::size_t z = 0; z < row.count; ++z) {
        dense[row.first + z] = change(from[z], row.column);
      }
    });
  }
  void spread(Field field, std::span<float> dense) const {
    spread(field, dense, [](float value, std::size_t) { return value; });
  }

private:
  /// A vertical run of voxels in a block and its position in a dense array.
  struct Row {
    std::size_t block, within;        ///< block, and its first voxel in the block
    std::size_t column, first, count; ///< position in the dense array
  };
  /// Calls f(row) for the rows of all stored blocks.
  template <class Function> void each_row(const Function& f) const;

  void check_dense(std::size_t size) const;
  std::size_t number(const Place& at) const {
    return static_cast<std::size_t>((at[0] * blocks_[1] + at[1]) * blocks_[2] + at[2]);
  }

  Place place(std::size_t number) const {
    const auto n = static_cast<Index>(number);
    return {n / (blocks_[1] * blocks_[2]), n / blocks_[2] % blocks_[1], n % blocks_[2]};
  }

  Place shape_, blocks_{};
  double voxel_;
  Vector origin_;
  std::size_t fields_;
  std::shared_ptr<const NoiseFrame> noise_;
  std::vector<std::unique_ptr<float[]>> pool_; ///< values of each block; null: clear
};

template <class Function> void SparseSmoke::each_row(const Function& f) const {
  for (std::size_t n = 0; n < pool_.size(); ++n) {
    if (pool_[n] == nullptr) {
      continue;
    }
    const auto [i, j, k] = place(n);
    const Index end_x = std::min((i + 1) * side, shape_[0]);
    const Index end_y = std::min((j + 1) * side, shape_[1]);
    const auto count = static_cast<std::size_t>(std::min(side, shape_[2] - k * side));
    for (Index x = i * side; x < end_x; ++x) {
      for (Index y = j * side; y < end_y; ++y) {
        const Index column = x * shape_[1] + y;
        f(Row{n, static_cast<std::size_t>((x % side * side + y % side) * side),
              static_cast<std::size_t>(column),
              static_cast<std::size_t>(column * shape_[2] + k * side), count});
      }
    }
  }
}

} // namespace firetwin
