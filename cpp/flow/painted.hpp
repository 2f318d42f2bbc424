#pragma once

#include "base/sparse_smoke.hpp"
#include "flow/lattice.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace firetwin::flow {

/// What is painted of 8 by 8 columns of voxels from the bottom to the top, as it lies in the blocks
/// that it becomes. Small enough for a processor's cache, and used for one after the other.
class Painted {
public:
  using Field = SparseSmoke::Field;

  explicit Painted(const SparseSmoke& smoke);

  bool glows() const { return values_of_block_ > SparseSmoke::glow * SparseSmoke::block_size; }
  /// Where a voxel's density lies.
  std::size_t place(Index i, Index j, Index k) const {
    constexpr Index side = SparseSmoke::side;
    const auto within = static_cast<std::size_t>((i % side * side + j % side) * side + k % side);
    return static_cast<std::size_t>(k / side) * values_of_block_ + within;
  }
  void set(Field field, std::size_t place, float value) {
    values_[place + field * SparseSmoke::block_size] = value;
    used_[place / values_of_block_] = 1;
  }

  /// Keeps blocks in which something is left when smoke thinner than `thinnest` is clear, and
  /// begins anew.
  void move_to(SparseSmoke& smoke, Index i, Index j, float thinnest);

private:
  std::size_t values_of_block_;
  std::vector<float> values_;
  std::vector<std::uint8_t> used_; ///< of each block, whether anything was painted
};

} // namespace firetwin::flow
