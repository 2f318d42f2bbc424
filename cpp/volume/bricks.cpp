#include "volume/bricks.hpp"

#include "volume/half.hpp"
#include "volume/voxel_grid.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>

namespace firetwin::volume {
namespace {

using Index = std::int64_t;
using Place = SparseSmoke::Place;
static_assert(SparseSmoke::side == Bricks::side);

/// Returns whether a block, or the border that it shares with its neighbours, has smoke above the
/// threshold.
bool has_smoke(const SparseSmoke& smoke, const VisibleShare& visible, const Place& block) {
  constexpr Index side = SparseSmoke::side;
  for (Index corner = 0; corner < 8; ++corner) {
    const Place high{corner & 1, corner >> 1 & 1, corner >> 2};
    const Place at{block[0] + high[0], block[1] + high[1], block[2] + high[2]};
    const float* values = smoke.block(at, SparseSmoke::density);
    const auto end = [&](std::size_t axis) { return high[axis] != 0 ? Index{1} : side; };
    for (Index x = 0; values != nullptr && x < end(0); ++x) {
      for (Index y = 0; y < end(1); ++y) {
        const float* row = values + (x * side + y) * side;
        const float most = *std::max_element(row, row + end(2));
        const Index column = (at[0] * side + x) * smoke.shape()[1] + at[1] * side + y;
        if (most > 0.0F &&
            visible.density(most, static_cast<std::size_t>(column)) > Bricks::min_extinction) {
          return true;
        }
      }
    }
  }
  return false;
}

/// Packs a lit block and its borders.
class Packer {
public:
  Packer(const LitSmoke& lit, const VisibleShare& visible) : lit_(lit), visible_(visible) {}

  void pack(const Place& block, std::uint16_t* out) {
    gather(block);
    const auto& shape = lit_.smoke().shape();
    Place last{};
    for (std::size_t axis = 0; axis < last.size(); ++axis) {
      last[axis] = std::min(wide, shape[axis] - block[axis] * SparseSmoke::side) - 1;
    }
    for (Index i = 0; i < wide; ++i) {
      for (Index j = 0; j < wide; ++j, out += wide * static_cast<Index>(Bricks::channels)) {
        const Index x = std::min(i, last[0]), y = std::min(j, last[1]);
        const Index column =
            (block[0] * SparseSmoke::side + x) * shape[1] + block[1] * SparseSmoke::side + y;
        pack_row(x, y, static_cast<std::size_t>(column), last[2], out);
      }
    }
  }

private:
  static constexpr Index wide = Bricks::wide;
  static constexpr Index row_size = Neighbourhood::row;
  static constexpr std::size_t voxels = wide * wide * row_size;
  using Voxels = std::array<float, voxels>;

  void gather(const Place& block) {
    lit_.gather(block, around_);
    lit_.light(block, around_, light_);
    const SparseSmoke& smoke = lit_.smoke();
    smoke.gather(SparseSmoke::fresh, block, 0, wide, fresh_.data());
    smoke.gather(SparseSmoke::edge, block, 0, wide, edge_.data());
    smoke.gather(SparseSmoke::veil, block, 0, wide, veil_.data());
    if (smoke.glows()) {
      smoke.gather(SparseSmoke::glow, block, 0, wide, glow_.data());
    }
  }

  void pack_row(Index x, Index y, std::size_t column, Index last, std::uint16_t* out) const {
    const float* density = around_.at(x, y);
    const Index row = x * wide + y;
    const Index own = row * row_size + SparseSmoke::side;
    const float *fresh = fresh_.data() + own, *glow = glow_.data() + own,
                *edge = edge_.data() + own, *veil = veil_.data() + own;
    const float *sun = light_.sun.data() + row * BlockLight::row,
                *sky = light_.sky.data() + row * BlockLight::row;
    for (Index k = 0; k < wide; ++k, out += Bricks::channels) {
      const Index z = std::min(k, last);
      const float seen = visible_.density(density[z], column);
      const float plain = density[z] > 0.0F ? seen * std::min(veil[z] / density[z], 1.0F) : 0.0F;
      Bricks::write({seen, fresh[z], sun[z], sky[z], glow[z],
                     std::clamp(edge[z] - 1.0F, 0.0F, 1.0F), edge[z], plain},
                    out);
    }
  }

  const LitSmoke& lit_;
  const VisibleShare& visible_;
  Neighbourhood around_;
  BlockLight light_;
  Voxels fresh_{}, glow_{}, edge_{}, veil_{};
};

void check_fields(const Bricks::Fields& fields) {
  for (const auto values : {fields.fresh, fields.sun, fields.sky}) {
    if (values.size() != fields.density.size()) {
      throw std::invalid_argument("fresh, sun and sky must have the shape of density");
    }
  }
  if (!fields.glow.empty() && fields.glow.size() != fields.density.size()) {
    throw std::invalid_argument("glow must have the shape of density");
  }
  if (!fields.edge.empty() && fields.edge.size() != fields.density.size()) {
    throw std::invalid_argument("edge must have the shape of density");
  }
}

} // namespace

void Bricks::write(const std::array<float, channels>& voxel, std::uint16_t* out) {
  std::transform(voxel.begin(), voxel.end(), out, to_half);
}

template <class HasSmoke, class Filler>
void Bricks::build(const HasSmoke& has_smoke, const Filler& filler) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    blocks_[axis] = std::max((shape_[axis] - 2) / side + 1, Index{1});
  }
  index_.assign(static_cast<std::size_t>(blocks_[0] * blocks_[1] * blocks_[2]), -1);
  const auto each_column = [this](const auto& f) {
    tbb::parallel_for(Index{0}, blocks_[0] * blocks_[1], [&](Index column) {
      f(column,
        [&, column](Index k) { return Place{column / blocks_[1], column % blocks_[1], k}; });
    });
  };
  each_column([&](Index column, const auto& place) {
    for (Index k = 0; k < blocks_[2]; ++k) {
      index_[static_cast<std::size_t>(column * blocks_[2] + k)] = has_smoke(place(k)) ? 0 : -1;
    }
  });
  for (std::int32_t& number : index_) {
    number = number < 0 ? -1 : static_cast<std::int32_t>(used_++);
  }
  pool_ = std::make_unique_for_overwrite<std::uint16_t[]>(used_ * block_size);
  each_column([&](Index column, const auto& place) {
    auto fill = filler();
    for (Index k = 0; k < blocks_[2]; ++k) {
      const std::int32_t number = index_[static_cast<std::size_t>(column * blocks_[2] + k)];
      if (number >= 0) {
        fill(place(k), pool_.get() + static_cast<std::size_t>(number) * block_size);
      }
    }
  });
}

Bricks::Bricks(const Fields& fields, const std::array<Index, 3>& shape, double voxel,
               const Vector& origin)
    : shape_(shape), voxel_(voxel), origin_(origin) {
  check(VoxelGrid{fields.density, shape, voxel, origin});
  check_fields(fields);
  build([&](const Place& at) { return has_smoke(fields.density, at); },
        [&] { return [&](const Place& at, std::uint16_t* out) { pack(fields, at, out); }; });
}

Bricks::Bricks(const LitSmoke& lit, const VisibleShare& visible)
    : shape_(lit.smoke().shape()), voxel_(lit.smoke().voxel()), origin_(lit.smoke().origin()),
      noise_(lit.smoke().noise()) {
  if (visible.share.size() != static_cast<std::size_t>(shape_[0] * shape_[1])) {
    throw std::invalid_argument("share must have the shape of the smoke along x and y");
  }
  build([&](const Place& at) { return volume::has_smoke(lit.smoke(), visible, at); },
        [&] {
          return [packer = std::make_unique<Packer>(lit, visible)](
                     const Place& at, std::uint16_t* out) { packer->pack(at, out); };
        });
}

/// Returns whether a block of dense smoke, or one of its borders, has smoke above the threshold.
bool Bricks::has_smoke(std::span<const float> density, const Place& at) const {
  const Index i = at[0] * side, j = at[1] * side, k = at[2] * side;
  const Index count = std::min(wide, shape_[2] - k);
  for (Index x = i; x < std::min(i + wide, shape_[0]); ++x) {
    for (Index y = j; y < std::min(j + wide, shape_[1]); ++y) {
      const float* row = density.data() + (x * shape_[1] + y) * shape_[2] + k;
      if (*std::max_element(row, row + count) > min_extinction) {
        return true;
      }
    }
  }
  return false;
}

void Bricks::pack(const Fields& fields, const Place& block, std::uint16_t* out) const {
  for (Index i = 0; i < wide; ++i) {
    const Index x = std::min(block[0] * side + i, shape_[0] - 1);
    for (Index j = 0; j < wide; ++j) {
      const Index y = std::min(block[1] * side + j, shape_[1] - 1);
      for (Index k = 0; k < wide; ++k, out += channels) {
        const Index z = std::min(block[2] * side + k, shape_[2] - 1);
        const auto at = static_cast<std::size_t>((x * shape_[1] + y) * shape_[2] + z);
        const float glow = fields.glow.empty() ? 0.0F : fields.glow[at];
        const float edge = fields.edge.empty() ? 1.0F : fields.edge[at];
        write({fields.density[at], fields.fresh[at], fields.sun[at], fields.sky[at], glow,
               std::clamp(edge, 0.0F, 1.0F), 1.0F + std::clamp(edge, -1.0F, 2.0F),
               fields.edge.empty() ? fields.density[at] : 0.0F},
              out);
      }
    }
  }
}

} // namespace firetwin::volume
