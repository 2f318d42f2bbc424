#include "volume/bricks.hpp"

#include "volume/brick.hpp"
#include "volume/half.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>

namespace firetwin::volume {

using Index = std::int64_t;

Bricks::Bricks(const Fields& fields, const std::array<Index, 3>& shape, double voxel,
               const Vector& origin)
    : shape_(shape), voxel_(voxel), origin_(origin) {
  check(Brick{fields.density, shape, voxel, origin});
  for (const auto values : {fields.fresh, fields.sun, fields.sky}) {
    if (values.size() != fields.density.size()) {
      throw std::invalid_argument("all fields of smoke must have the shape of its density");
    }
  }
  if (!fields.glow.empty() && fields.glow.size() != fields.density.size()) {
    throw std::invalid_argument("glow must have the shape of the density");
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    blocks_[axis] = std::max((shape[axis] - 2) / side + 1, Index{1});
  }
  const auto found = smoky(fields.density);
  index_.assign(found.size(), -1);
  std::int32_t used = 0;
  for (std::size_t n = 0; n < found.size(); ++n) {
    index_[n] = found[n] != 0 ? used++ : -1;
  }
  pool_.resize(static_cast<std::size_t>(used) * block_size);
  tbb::parallel_for(Index{0}, blocks_[0] * blocks_[1], [&](Index column) {
    for (Index k = 0; k < blocks_[2]; ++k) {
      const auto n = static_cast<std::size_t>(column * blocks_[2] + k);
      if (index_[n] >= 0) {
        pack(fields, column / blocks_[1], column % blocks_[1], k,
             pool_.data() + static_cast<std::size_t>(index_[n]) * block_size);
      }
    }
  });
}

/// Which blocks hold smoke, their borders with them.
std::vector<std::uint8_t> Bricks::smoky(std::span<const float> density) const {
  std::vector<std::uint8_t> found(static_cast<std::size_t>(blocks_[0] * blocks_[1] * blocks_[2]));
  tbb::parallel_for(Index{0}, blocks_[0] * blocks_[1], [&](Index column) {
    const Index first_i = column / blocks_[1] * side, first_j = column % blocks_[1] * side;
    for (Index k = 0; k < blocks_[2]; ++k) {
      const Index count = std::min(wide, shape_[2] - k * side);
      float most = 0.0F;
      for (Index i = first_i; i < std::min(first_i + wide, shape_[0]); ++i) {
        for (Index j = first_j; j < std::min(first_j + wide, shape_[1]); ++j) {
          const float* row = density.data() + (i * shape_[1] + j) * shape_[2] + k * side;
          most = std::max(most, *std::max_element(row, row + count));
        }
      }
      found[static_cast<std::size_t>(column * blocks_[2] + k)] = most > thinnest;
    }
  });
  return found;
}

void Bricks::pack(const Fields& fields, Index bi, Index bj, Index bk, std::uint16_t* out) const {
  for (Index i = 0; i < wide; ++i) {
    const Index x = std::min(bi * side + i, shape_[0] - 1);
    for (Index j = 0; j < wide; ++j) {
      const Index y = std::min(bj * side + j, shape_[1] - 1);
      for (Index k = 0; k < wide; ++k, out += channels) {
        const Index z = std::min(bk * side + k, shape_[2] - 1);
        const auto at = static_cast<std::size_t>((x * shape_[1] + y) * shape_[2] + z);
        out[0] = to_half(fields.density[at]);
        out[1] = to_half(fields.fresh[at]);
        out[2] = to_half(fields.sun[at]);
        out[3] = to_half(fields.sky[at]);
        out[4] = fields.glow.empty() ? std::uint16_t{0} : to_half(fields.glow[at]);
      }
    }
  }
}

} // namespace firetwin::volume
