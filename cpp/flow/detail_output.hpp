#pragma once

#include "base/sparse_smoke.hpp"
#include "flow/lattice.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace firetwin::flow {

/// Output buffer of `Detail`: 8 x 8 columns of voxels, from bottom to top, in the memory layout of
/// the sparse grid's blocks. It fits into a processor's cache and is reused.
class DetailOutput {
public:
  using Field = SparseSmoke::Field;

  explicit DetailOutput(const SparseSmoke& smoke);

  bool glows() const { return values_of_block_ > SparseSmoke::glow * SparseSmoke::block_size; }
  /// Offset of a voxel's density.
  std::size_t place(Index i, Index j, Index k) const {
    constexpr Index side = SparseSmoke::side;
    const auto within = static_cast<std::size_t>((i % side * side + j % side) * side + k % side);
    return static_cast<std::size_t>(k / side) * values_of_block_ + within;
  }
  void set(Field field, std::size_t place, float value) {
    values_[place + field * SparseSmoke::block_size] = value;
    used_[place / values_of_block_] = 1;
  }

  /// Clears smoke below `min_extinction`, moves the remaining blocks to the grid and resets the
  /// buffer.
  void move_to(SparseSmoke& smoke, Index i, Index j, float min_extinction);

private:
  std::size_t values_of_block_;
  std::vector<float> values_;
  std::vector<std::uint8_t> used_; ///< by block: has painted voxels
};

} // namespace firetwin::flow
