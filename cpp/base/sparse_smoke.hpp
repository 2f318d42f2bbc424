#pragma once

#include "base/vector.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace firetwin {

/// Sparse voxel grid of smoke: blocks of 8^3 voxels, clear blocks are not stored. x is slowest and
/// z fastest, among blocks as well as in them.
class SparseSmoke {
public:
  using Index = std::int64_t;
  using Place = std::array<Index, 3>;
  enum Field : std::size_t {
    density, ///< extinction, 1/m
    fresh,   ///< 1 where smoke is young, 0 where it is old or none
    glow     ///< light of flames; there may be none
  };
  static constexpr Index side = 8;
  static constexpr std::size_t block_size = side * side * side;

  /// Clear at first.
  /// @param shape voxels along x, y and z
  /// @param origin centre of the first voxel, m
  SparseSmoke(const Place& shape, double voxel, const Vector& origin, bool glows);

  const Place& shape() const { return shape_; }
  const Place& blocks() const { return blocks_; }
  double voxel() const { return voxel_; }
  const Vector& origin() const { return origin_; }
  bool glows() const { return fields_ > glow; }
  /// Values of a block: all of a field, then all of the next.
  std::size_t values() const { return fields_ * block_size; }
  std::size_t used() const;

  /// A block's values of a field; null where it is clear, or beyond all blocks.
  const float* block(const Place& at, Field field) const {
    for (std::size_t axis = 0; axis < at.size(); ++axis) {
      if (at[axis] < 0 || at[axis] >= blocks_[axis]) {
        return nullptr;
      }
    }
    const float* found = pool_[number(at)].get();
    return found == nullptr ? nullptr : found + field * block_size;
  }
  /// Gives a block its values. Several threads may, each other blocks.
  void keep(const Place& at, std::span<const float> values);

  /// Keeps blocks of a dense array of densities in which there are any.
  void keep_all(std::span<const float> dense);

  /// Copies a block and what is round it, zeros where it is clear or beyond: columns from `before`
  /// voxels before it on, `count` of them along x and y, and along z the block and the two beside
  /// it, to out[(x * count + y) * 3 * side].
  void gather(Field field, const Place& block, Index before, Index count, float* out) const;
  /// Writes what is not clear into a dense array of zeros: `change(value, column)`, columns being
  /// counted along x, then y.
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
  /// Voxels one above the other in a block, and in a dense array.
  struct Row {
    std::size_t block, within;        ///< its first
    std::size_t column, first, count; ///< the same
  };
  /// f(row) for the rows of blocks that are not clear.
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
  std::vector<std::unique_ptr<float[]>> pool_; ///< of each block; null: clear
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
