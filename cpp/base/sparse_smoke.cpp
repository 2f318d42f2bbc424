#include "base/sparse_smoke.hpp"

#include "base/check.hpp"

#include <algorithm>
#include <stdexcept>

namespace firetwin {

SparseSmoke::SparseSmoke(const Place& shape, double voxel, const Vector& origin, bool glows)
    : shape_(shape), voxel_(voxel), origin_(origin), fields_(glows ? glow + 1 : glow) {
  if (std::min({shape[0], shape[1], shape[2]}) < 1) {
    throw std::invalid_argument("smoke needs at least one voxel along each axis");
  }
  check_above_zero(voxel, "voxel_size");
  check_finite(origin, "origin");
  for (std::size_t axis = 0; axis < shape.size(); ++axis) {
    blocks_[axis] = (shape[axis] + side - 1) / side;
  }
  pool_.resize(static_cast<std::size_t>(blocks_[0] * blocks_[1] * blocks_[2]));
}

std::size_t SparseSmoke::used() const {
  return pool_.size() - static_cast<std::size_t>(std::count(pool_.begin(), pool_.end(), nullptr));
}

void SparseSmoke::keep(const Place& at, std::span<const float> values) {
  auto& kept = pool_[number(at)];
  kept = std::make_unique_for_overwrite<float[]>(values.size());
  std::copy(values.begin(), values.end(), kept.get());
}

void SparseSmoke::gather(Field field, const Place& at, Index before, Index count,
                         float* out) const {
  static constexpr std::array<float, block_size> clear{};
  const auto values = [&](Index i, Index j, Index k) {
    const float* found = block({at[0] + i, at[1] + j, at[2] + k}, field);
    return found == nullptr ? clear.data() : found;
  };
  // Along an axis: the voxel range of the previous, this and the next block.
  const auto first = [&](Index block) { return std::max(block * side, -before); };
  const auto end = [&](Index block) { return std::min((block + 1) * side, count - before); };
  for (Index i = -1; i <= 1; ++i) {
    for (Index j = -1; j <= 1; ++j) {
      const std::array<const float*, 3> from{values(i, j, -1), values(i, j, 0), values(i, j, 1)};
      for (Index x = first(i); x < end(i); ++x) {
        for (Index y = first(j); y < end(j); ++y) {
          const Index within = ((x - i * side) * side + y - j * side) * side;
          float* row = out + ((x + before) * count + y + before) * 3 * side;
          for (Index k = 0; k < 3; ++k) {
            std::copy_n(from[static_cast<std::size_t>(k)] + within, side, row + k * side);
          }
        }
      }
    }
  }
}

void SparseSmoke::check_dense(std::size_t size) const {
  if (size != static_cast<std::size_t>(shape_[0] * shape_[1] * shape_[2])) {
    throw std::invalid_argument("a dense array must have the shape of the smoke");
  }
}

void SparseSmoke::keep_all(std::span<const float> dense) {
  check_dense(dense.size());
  for (std::size_t n = 0; n < pool_.size(); ++n) {
    const auto [i, j, k] = place(n);
    std::vector<float> values(fields_ * block_size);
    bool any = false;
    for (Index x = i * side; x < std::min((i + 1) * side, shape_[0]); ++x) {
      for (Index y = j * side; y < std::min((j + 1) * side, shape_[1]); ++y) {
        for (Index z = k * side; z < std::min((k + 1) * side, shape_[2]); ++z) {
          const float value = dense[static_cast<std::size_t>((x * shape_[1] + y) * shape_[2] + z)];
          const auto at = static_cast<std::size_t>((x % side * side + y % side) * side + z % side);
          values[at] = values[veil * block_size + at] = value;
          any = any || value != 0.0F;
        }
      }
    }
    if (any) {
      keep({i, j, k}, values);
    }
  }
}

} // namespace firetwin
