#include "volume/grid_resampler.hpp"

#include "base/clones.hpp"
#include "base/interpolation.hpp"

#include <algorithm>

namespace firetwin::volume {
namespace {

using Index = std::int64_t;

/// Four rows of values and their weights.
struct Rows {
  std::array<const float*, 4> values;
  std::array<float, 4> weight;
};

FIRETWIN_CLONES("avx512f", "avx2")
void mix_rows(const Rows& rows, const std::int32_t* __restrict low,
              const std::int32_t* __restrict high, const float* __restrict part,
              float* __restrict out) {
  const auto [a, b, c, d] = rows.values;
  const auto [wa, wb, wc, wd] = rows.weight;
  for (Index l = 0; l < GridResampler::lanes; ++l) {
    const float less = 1.0F - part[l], more = part[l];
    const std::int32_t m = low[l], n = high[l];
    float sum = wa * less * a[m];
    sum += wb * less * b[m];
    sum += wc * less * c[m];
    sum += wd * less * d[m];
    sum += wa * more * a[n];
    sum += wb * more * b[n];
    sum += wc * more * c[n];
    out[l] = sum + wd * more * d[n];
  }
}

} // namespace

GridResampler::GridResampler(const OwnedVoxelGrid& of, const std::array<Index, 3>& shape,
                             double voxel, const Vector& origin, const Vector& shift)
    : values_(of.values.data()), shape_(of.shape) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Axis& a = axes_[axis];
    for (Index n = 0; n < shape[axis] + lanes; ++n) {
      const auto voxels = static_cast<double>(std::min(n, shape[axis] - 1));
      const double place = origin[axis] + voxel * voxels + shift[axis];
      const auto at = interval_within((place - of.origin[axis]) / of.voxel, shape_[axis]);
      a.low.push_back(static_cast<std::int32_t>(at.low));
      a.high.push_back(static_cast<std::int32_t>(at.high));
      a.part.push_back(static_cast<float>(at.part));
    }
  }
}

void GridResampler::row(Index x, Index y, Index z, float* out) const {
  const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y),
             k = static_cast<std::size_t>(z);
  const std::array<Index, 2> columns{axes_[0].low[i], axes_[0].high[i]},
      rows{axes_[1].low[j], axes_[1].high[j]};
  Rows four{{}, bilinear_weights(axes_[1].part[j], axes_[0].part[i])};
  for (std::size_t n = 0; n < 4; ++n) {
    four.values[n] = values_ + (columns[n % 2] * shape_[1] + rows[n / 2]) * shape_[2];
  }
  const Axis& up = axes_[2];
  mix_rows(four, up.low.data() + k, up.high.data() + k, up.part.data() + k, out);
}

} // namespace firetwin::volume
