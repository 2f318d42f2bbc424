#include "volume/voxel_grid.hpp"

#include "base/check.hpp"
#include "base/interpolation.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>

namespace firetwin::volume {
namespace {

using Index = std::int64_t;

} // namespace

void check(const VoxelGrid& brick) {
  const Index count = brick.shape[0] * brick.shape[1] * brick.shape[2];
  if (count < 1 || brick.values.size() != static_cast<std::size_t>(count)) {
    throw std::invalid_argument("a voxel grid needs one value per voxel, and at least one voxel");
  }
  check_above_zero(brick.voxel, "voxel_size");
  check_finite(brick.origin, "origin");
}

float sample(const VoxelGrid& brick, const Vector& place) {
  const auto along = [&](std::size_t axis) {
    return interval_within((place[axis] - brick.origin[axis]) / brick.voxel, brick.shape[axis]);
  };
  const auto x = along(0), y = along(1), z = along(2);
  const auto weights = bilinear_weights(static_cast<float>(y.part), static_cast<float>(x.part));
  const auto up = static_cast<float>(z.part);
  float sum = 0.0F;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const bool east = corner % 2 != 0, north = corner / 2 % 2 != 0, high = corner / 4 != 0;
    const float weight = weights[corner % 4] * (high ? up : 1.0F - up);
    const Index row = (east ? x.high : x.low) * brick.shape[1] + (north ? y.high : y.low);
    const Index n = row * brick.shape[2] + (high ? z.high : z.low);
    sum += weight > 0.0F ? weight * brick.values[static_cast<std::size_t>(n)] : 0.0F;
  }
  return sum;
}

std::vector<std::uint8_t> near_smoke(const VoxelGrid& smoke) {
  const auto [nx, ny, nz] = smoke.shape;
  std::vector<std::uint8_t> near(smoke.values.size());
  tbb::parallel_for(Index{0}, nx * ny, [&, nz](Index row) {
    const float* v = smoke.values.data() + row * nz;
    std::uint8_t* out = near.data() + row * nz;
    for (Index k = 0; k < nz; ++k) {
      if (v[k] > 0.0F) {
        std::fill(out + std::max(k - 1, Index{0}), out + std::min(k + 2, nz), std::uint8_t{1});
      }
    }
  });
  // Rows are processed in memory order: each is widened by its neighbours.
  const auto widen = [&near, nz](std::uint8_t* first, Index count, Index stride) {
    std::vector<std::uint8_t> before(static_cast<std::size_t>(nz)), here(before);
    for (Index n = 0; n < count; ++n) {
      std::uint8_t* row = first + n * stride;
      const std::uint8_t* after = n + 1 < count ? row + stride : row;
      std::copy_n(row, nz, here.begin());
      for (Index k = 0; k < nz; ++k) {
        const auto at = static_cast<std::size_t>(k);
        row[k] = static_cast<std::uint8_t>(before[at] | here[at] | after[k]);
      }
      std::swap(before, here);
    }
  };
  tbb::parallel_for(Index{0}, nx,
                    [&, ny, nz](Index i) { widen(near.data() + i * ny * nz, ny, nz); });
  tbb::parallel_for(Index{0}, ny,
                    [&, nx, ny, nz](Index j) { widen(near.data() + j * nz, nx, ny * nz); });
  return near;
}

OwnedVoxelGrid halved(const VoxelGrid& smoke) {
  OwnedVoxelGrid coarse{{}, smoke.shape, 2.0 * smoke.voxel, smoke.origin};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    coarse.shape[axis] = (smoke.shape[axis] + 1) / 2;
    coarse.origin[axis] += 0.5 * smoke.voxel;
  }
  const auto [nx, ny, nz] = coarse.shape;
  coarse.values.assign(static_cast<std::size_t>(nx * ny * nz), 0.0F);
  tbb::parallel_for(Index{0}, nx, [&, ny, nz](Index i) {
    for (Index x = 2 * i; x < std::min(2 * i + 2, smoke.shape[0]); ++x) {
      for (Index y = 0; y < smoke.shape[1]; ++y) {
        const float* row = smoke.values.data() + (x * smoke.shape[1] + y) * smoke.shape[2];
        float* out = coarse.values.data() + (i * ny + y / 2) * nz;
        for (Index z = 0; z < smoke.shape[2]; ++z) {
          out[z / 2] += 0.125F * row[z];
        }
      }
    }
  });
  return coarse;
}

} // namespace firetwin::volume
