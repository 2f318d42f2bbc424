#include "volume/lit_smoke.hpp"

#include "base/check.hpp"
#include "base/clones.hpp"
#include "volume/sunlight.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace firetwin::volume {
namespace {

using Index = std::int64_t;
using Place = SparseSmoke::Place;
using Row = std::array<float, BlockLight::row>;

constexpr int fine_steps = 4; // up to the centre of the next but one voxel of twice the size
static_assert(fine_steps <= Neighbourhood::reach && BlockLight::row == GridResampler::lanes);

void check_direction(const Vector& direction) {
  check_finite(direction, "direction");
  if (std::abs(std::sqrt(dot(direction, direction)) - 1.0) > 1.0e-6) {
    throw std::invalid_argument("direction must be a unit vector");
  }
}

/// Averages 2^3 voxels; outside the smoke is clear.
OwnedVoxelGrid halved(const SparseSmoke& smoke) {
  OwnedVoxelGrid coarse{{}, smoke.shape(), 2.0 * smoke.voxel(), smoke.origin()};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    coarse.shape[axis] = (coarse.shape[axis] + 1) / 2;
    coarse.origin[axis] += 0.5 * smoke.voxel();
  }
  constexpr Index side = SparseSmoke::side;
  const auto [nx, ny, nz] = coarse.shape;
  const auto [blocks_x, blocks_y, blocks_z] = smoke.blocks();
  coarse.values.assign(static_cast<std::size_t>(nx * ny * nz), 0.0F);
  tbb::parallel_for(Index{0}, blocks_x, [&, ny, nz, blocks_y, blocks_z](Index i) {
    for (Index at = 0; at < blocks_y * blocks_z; ++at) {
      const Index j = at / blocks_z, k = at % blocks_z;
      const float* values = smoke.block({i, j, k}, SparseSmoke::density);
      if (values == nullptr) {
        continue;
      }
      const Index deep = std::min(side, smoke.shape()[2] - k * side);
      for (Index x = i * side; x < std::min((i + 1) * side, smoke.shape()[0]); ++x) {
        for (Index y = j * side; y < std::min((j + 1) * side, smoke.shape()[1]); ++y) {
          const float* row = values + (x % side * side + y % side) * side;
          float* out = coarse.values.data() + (x / 2 * ny + y / 2) * nz + k * side / 2;
          for (Index z = 0; z < deep; ++z) {
            out[z / 2] += 0.125F * row[z];
          }
        }
      }
    }
  });
  return coarse;
}

std::shared_ptr<const LightDepths> light_depths(const SparseSmoke& smoke, const Vector& direction,
                                                const LightDepths* beyond) {
  OwnedVoxelGrid coarse = halved(smoke);
  const std::optional<VoxelGrid> outside =
      beyond == nullptr ? std::nullopt : std::optional(beyond->sun.view());
  SkyDepths sky =
      sky_depths(volume::halved(coarse.view()).view(), beyond == nullptr ? nullptr : &beyond->sky);
  coarse.values = optical_depth(coarse.view(), direction, outside ? &*outside : nullptr);
  return std::make_shared<const LightDepths>(LightDepths{std::move(coarse), std::move(sky)});
}

OwnedVoxelGrid sky_light_grid(const SkyDepths& depths, double part) {
  return {sky_light(depths, part), depths[0].shape, depths[0].voxel, depths[0].origin};
}

FIRETWIN_CLONES("avx512f", "avx2")
void add_weighted(const float* smoke, const std::ptrdiff_t* offsets, const float* weights,
                  std::size_t count, float* out) {
  Row sum{};
  for (std::size_t m = 0; m < count; ++m) {
    const float* from = smoke + offsets[m];
    for (std::size_t l = 0; l < sum.size(); ++l) {
      sum[l] += weights[m] * from[l];
    }
  }
  std::copy(sum.begin(), sum.end(), out);
}

/// Maximum over the 3 x 3 x 3 neighbourhood of each of a block's voxels, axis by axis.
class MaxFilter3 {
public:
  explicit MaxFilter3(const Neighbourhood& around);

  const Row& row(Index x, Index y) const { return rows_[number(x, y)]; }

private:
  static constexpr Index wide = BlockLight::wide + 2; // one more on each side
  static std::size_t number(Index x, Index y) {
    return static_cast<std::size_t>((x + 1) * wide + y + 1);
  }
  /// Takes the maximum with the previous and the next row; `step` is their distance in rows.
  void widen(Index first, Index step);

  std::array<Row, static_cast<std::size_t>(wide* wide)> rows_;
};

FIRETWIN_CLONES("avx512f", "avx2")
void max_of_three(const float* a, const float* b, const float* c, float* out) {
  for (Index l = 0; l < BlockLight::row; ++l) {
    out[l] = std::max(std::max(a[l], b[l]), c[l]);
  }
}

MaxFilter3::MaxFilter3(const Neighbourhood& around) {
  for (Index x = -1; x < wide - 1; ++x) {
    for (Index y = -1; y < wide - 1; ++y) {
      const float* row = around.at(x, y);
      max_of_three(row - 1, row, row + 1, rows_[number(x, y)].data());
    }
  }
  for (Index n = 0; n < wide; ++n) {
    widen(n * wide, 1);
  }
  for (Index n = 0; n < wide; ++n) {
    widen(n, wide);
  }
}

void MaxFilter3::widen(Index first, Index step) {
  Row before = rows_[static_cast<std::size_t>(first)];
  for (Index n = 1; n < wide - 1; ++n) {
    Row& here = rows_[static_cast<std::size_t>(first + n * step)];
    const Row own = here;
    max_of_three(before.data(), own.data(),
                 rows_[static_cast<std::size_t>(first + (n + 1) * step)].data(), here.data());
    before = own;
  }
}

/// Calls f(block) for blocks with smoke and for their neighbours.
template <class Function> void each_near(const SparseSmoke& smoke, const Function& f) {
  const auto [nx, ny, nz] = smoke.blocks();
  tbb::parallel_for(Index{0}, nx * ny, [&, ny, nz](Index column) {
    for (Index k = 0; k < nz; ++k) {
      const Place at{column / ny, column % ny, k};
      bool near = false;
      for (Index n = 0; n < 27 && !near; ++n) {
        near = smoke.block({at[0] + n / 9 - 1, at[1] + n / 3 % 3 - 1, at[2] + n % 3 - 1},
                           SparseSmoke::density) != nullptr;
      }
      if (near) {
        f(at);
      }
    }
  });
}

} // namespace

void dim_glow(SparseSmoke& smoke, double part) {
  if (!smoke.glows()) {
    return;
  }
  OwnedVoxelGrid below = halved(smoke);
  below.values = optical_depth(below.view(), {0.0, 0.0, -1.0}, nullptr);
  const GridResampler depth(below, smoke.shape(), smoke.voxel(), smoke.origin(), {});
  constexpr Index side = SparseSmoke::side;
  const auto [nx, ny, nz] = smoke.blocks();
  tbb::parallel_for(Index{0}, nx * ny, [&, ny, nz](Index column) {
    for (Index k = 0; k < nz; ++k) {
      const Place at{column / ny, column % ny, k};
      float* glow = smoke.block(at, SparseSmoke::glow);
      for (Index n = 0; glow != nullptr && n < side * side; ++n, glow += side) {
        const Index x = at[0] * side + n / side, y = at[1] * side + n % side;
        if (x < smoke.shape()[0] && y < smoke.shape()[1]) {
          Row found;
          depth.row(x, y, k * side, found.data());
          for (Index z = 0; z < side; ++z) {
            glow[z] *= std::exp(-static_cast<float>(part) * found[static_cast<std::size_t>(z)]);
          }
        }
      }
    }
  });
}

/// Computes weights for the sum of smoke along the first `fine_steps` voxels of the ray, linear
/// between voxels.
LitSmoke::Stencil::Stencil(const Vector& direction) {
  std::map<Place, double> found;
  for (int step = 0; step < fine_steps; ++step) {
    for (unsigned corner = 0; corner < 8; ++corner) {
      Place at{};
      double weight = 1.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double moved = (step + 0.5) * direction[axis], under = std::floor(moved);
        const bool over = (corner >> axis & 1U) != 0;
        at[axis] = static_cast<Index>(under) + (over ? 1 : 0);
        weight *= over ? moved - under : 1.0 - (moved - under);
      }
      if (weight > 0.0) {
        found[at] += weight;
      }
    }
  }
  for (const auto& [at, weight] : found) {
    offsets.push_back((at[0] * Neighbourhood::count + at[1]) * Neighbourhood::row + at[2]);
    weights.push_back(static_cast<float>(weight));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], at[axis]);
      high[axis] = std::max(high[axis], at[axis]);
    }
  }
}

LitSmoke::LitSmoke(std::shared_ptr<const SparseSmoke> smoke, const Vector& direction,
                   const LightDepths* beyond, std::array<double, 2> factors)
    : smoke_((check_direction(direction), std::move(smoke))),
      log_attenuation_(static_cast<float>(-factors[0])),
      depths_(light_depths(*smoke_, direction, beyond)),
      sky_light_(sky_light_grid(depths_->sky, factors[1])), first_steps_(direction) {
  const auto between = [this](const OwnedVoxelGrid& values, double steps, const Vector& way) {
    Vector shift{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      shift[axis] = steps * smoke_->voxel() * way[axis];
    }
    return GridResampler(values, smoke_->shape(), smoke_->voxel(), smoke_->origin(), shift);
  };
  sky_ = between(sky_light_, 0.0, direction);
  depth_ = between(depths_->sun, 0.0, direction);
  depth_beyond_ = between(depths_->sun, fine_steps, direction);
}

void LitSmoke::gather(const Place& block, Neighbourhood& out) const {
  smoke_->gather(SparseSmoke::density, block, Neighbourhood::reach, Neighbourhood::count,
                 out.density.data());
}

/// Computes optical depths to the sun of a row of voxels from `first`; `own` is their smoke.
void LitSmoke::find_sun_depths(const Place& first, const float* own, float* out) const {
  // If the stencil does not fit, near the sides of the grid, the coarse depth is used from the
  // start.
  const auto fits = [&](std::size_t axis, Index at) {
    return at + first_steps_.low[axis] >= 0 && at + first_steps_.high[axis] < smoke_->shape()[axis];
  };
  const Index last = std::min(first[2] + BlockLight::wide, smoke_->shape()[2]) - 1;
  const bool row_fits = fits(0, first[0]) && fits(1, first[1]);
  const bool all_fit = row_fits && fits(2, first[2]) && fits(2, last);
  Row coarse;
  if (!all_fit) {
    depth_->row(first[0], first[1], first[2], coarse.data());
  }
  if (!row_fits) {
    std::copy(coarse.begin(), coarse.end(), out);
    return;
  }
  Row sum;
  add_weighted(own, first_steps_.offsets.data(), first_steps_.weights.data(),
               first_steps_.weights.size(), sum.data());
  depth_beyond_->row(first[0], first[1], first[2], out);
  const auto step = static_cast<float>(smoke_->voxel());
  for (std::size_t l = 0; l < sum.size(); ++l) {
    const bool fine = all_fit || fits(2, first[2] + static_cast<Index>(l));
    out[l] = fine ? sum[l] * step + out[l] : coarse[l];
  }
}

bool LitSmoke::light(const Place& block, const Neighbourhood& around, BlockLight& out) const {
  constexpr Index side = SparseSmoke::side;
  const auto& shape = smoke_->shape();
  const auto [nx, ny, nz] = std::array{std::min(BlockLight::wide, shape[0] - block[0] * side),
                                       std::min(BlockLight::wide, shape[1] - block[1] * side),
                                       std::min(BlockLight::wide, shape[2] - block[2] * side)};
  bool any = false;
  const MaxFilter3 filtered(around);
  Row depth, sky;
  for (Index x = 0; x < nx; ++x) {
    for (Index y = 0; y < ny; ++y) {
      float* sun_out = out.sun.data() + (x * BlockLight::wide + y) * BlockLight::row;
      float* sky_out = out.sky.data() + (x * BlockLight::wide + y) * BlockLight::row;
      std::fill_n(sun_out, BlockLight::wide, 0.0F);
      std::fill_n(sky_out, BlockLight::wide, 0.0F);
      const Row& near = filtered.row(x, y);
      if (std::none_of(near.begin(), near.begin() + nz, [](float most) { return most > 0.0F; })) {
        continue;
      }
      any = true;
      const Place first{block[0] * side + x, block[1] * side + y, block[2] * side};
      find_sun_depths(first, around.at(x, y), depth.data());
      sky_->row(first[0], first[1], first[2], sky.data());
      for (Index z = 0; z < nz; ++z) {
        const auto l = static_cast<std::size_t>(z);
        if (near[l] > 0.0F) {
          sun_out[z] = std::exp(log_attenuation_ * depth[l]);
          sky_out[z] = sky[l];
        }
      }
    }
  }
  return any;
}

void LitSmoke::write_dense(std::span<float> sun, std::span<float> sky) const {
  constexpr Index side = SparseSmoke::side;
  const auto& shape = smoke_->shape();
  const auto count = static_cast<std::size_t>(shape[0] * shape[1] * shape[2]);
  if (sun.size() != count || sky.size() != count) {
    throw std::invalid_argument("sun and sky must have the shape of the smoke");
  }
  each_near(*smoke_, [&](const Place& block) {
    Neighbourhood around;
    BlockLight found;
    gather(block, around);
    if (!light(block, around, found)) {
      return;
    }
    const Index nz = std::min(side, shape[2] - block[2] * side);
    for (Index x = 0; x < std::min(side, shape[0] - block[0] * side); ++x) {
      for (Index y = 0; y < std::min(side, shape[1] - block[1] * side); ++y) {
        const Index from = (x * BlockLight::wide + y) * BlockLight::row;
        const Index to =
            ((block[0] * side + x) * shape[1] + block[1] * side + y) * shape[2] + block[2] * side;
        std::copy_n(found.sun.data() + from, nz, sun.data() + to);
        std::copy_n(found.sky.data() + from, nz, sky.data() + to);
      }
    }
  });
}

} // namespace firetwin::volume
