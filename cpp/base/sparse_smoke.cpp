#include "base/sparse_smoke.hpp"

#include "base/check.hpp"

#include <algorithm>
#include <stdexcept>

namespace firetwin {

SparseSmoke::SparseSmoke(const Place& shape, double voxel, const Vector& origin, bool glows)
    : shape_(shape), voxel_(voxel), origin_(origin), fields_(glows ? glow + 1 : glow) {
  if (std::min({shape[0], shape[1], shape[2]}) < 1) {
    throw std::invalid_argument("smoke needs one voxel or more along each side");
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

void SparseSmoke::gather(Field field, const Place& first, Index count, Index row,
                         float* out) const {
  const auto block_of = [](Index voxel) { return (voxel + side) / side - 1; }; // also of -side
  Place last{};
  for (std::size_t axis = 0; axis < last.size(); ++axis) {
    last[axis] = block_of(first[axis] + count - 1);
  }
  for (Index i = block_of(first[0]); i <= last[0]; ++i) {
    const Index x0 = std::max(first[0], i * side), x1 = std::min(first[0] + count, (i + 1) * side);
    for (Index j = block_of(first[1]); j <= last[1]; ++j) {
      const Index y0 = std::max(first[1], j * side),
                  y1 = std::min(first[1] + count, (j + 1) * side);
      for (Index k = block_of(first[2]); k <= last[2]; ++k) {
        const Index z0 = std::max(first[2], k * side),
                    z1 = std::min(first[2] + count, (k + 1) * side);
        const float* from = block({i, j, k}, field);
        for (Index x = x0; x < x1; ++x) {
          for (Index y = y0; y < y1; ++y) {
            float* to = out + ((x - first[0]) * count + y - first[1]) * row + z0 - first[2];
            if (from == nullptr) {
              std::fill_n(to, z1 - z0, 0.0F);
            } else {
              std::copy_n(from + ((x - i * side) * side + y - j * side) * side + z0 - k * side,
                          z1 - z0, to);
            }
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
          values[static_cast<std::size_t>((x % side * side + y % side) * side + z % side)] = value;
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
