#include "flow/filters.hpp"

#include "base/clones.hpp"
#include "base/simd.hpp"
#include "flow/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace firetwin::flow {
namespace {

/// Rows within the filter's width, of equal length, in order.
using Rows = std::span<const float* const>;

using Wide = Simd<float, static_cast<std::size_t>(lanes)>;

/// Accumulates in registers over all rows, which takes half the time of adding row by row. The last
/// two Wides overlap the previous ones.
FIRETWIN_CLONES("avx512f", "avx2")
void weighted(Rows rows, const float* weight, Index n, float* to) {
  if (n < 2 * lanes) {
    for (Index i = 0; i < n; ++i) {
      to[i] = 0.0F;
      for (std::size_t r = 0; r < rows.size(); ++r) {
        to[i] += weight[r] * rows[r][i];
      }
    }
    return;
  }
  for (Index next = 0; next < n; next += 2 * lanes) {
    const Index i = std::min(next, n - 2 * lanes);
    Wide sum{}, more{};
    for (std::size_t r = 0; r < rows.size(); ++r) {
      Wide from, beyond;
      load(rows[r] + i, from);
      load(rows[r] + i + lanes, beyond);
      sum += weight[r] * from;
      more += weight[r] * beyond;
    }
    store(sum, to + i);
    store(more, to + i + lanes);
  }
}

FIRETWIN_CLONES("avx512f", "avx2")
void largest(Rows rows, Index n, float* __restrict to) {
  std::copy(rows[0], rows[0] + n, to);
  for (std::size_t r = 1; r < rows.size(); ++r) {
    const float* __restrict from = rows[r];
    for (Index i = 0; i < n; ++i) {
      to[i] = to[i] < from[i] ? from[i] : to[i];
    }
  }
}

/// Calls f(rows, to) for each row along x; `rows` are those within `reach` cells along an axis,
/// clamped at the edges. Along x itself, rows are shifted by copying.
template <class Function>
void along(const std::vector<float>& values, const Shape& s, int axis, Index reach,
           std::vector<float>& out, const Function& f) {
  each(s.nz, [&](Index k) {
    std::vector<float> line(static_cast<std::size_t>(s.nx + 2 * reach));
    std::vector<const float*> rows(static_cast<std::size_t>(2 * reach + 1));
    for (Index j = 0; j < s.ny; ++j) {
      const auto row = [&](Index level, Index at) {
        return values.data() +
               (std::clamp(level, Index{0}, s.nz - 1) * s.ny + std::clamp(at, Index{0}, s.ny - 1)) *
                   s.nx;
      };
      if (axis == 2) {
        const float* here = row(k, j);
        std::fill_n(line.begin(), reach, here[0]);
        std::copy_n(here, s.nx, line.begin() + reach);
        std::fill_n(line.begin() + reach + s.nx, reach, here[s.nx - 1]);
      }
      for (Index offset = -reach; offset <= reach; ++offset) {
        rows[static_cast<std::size_t>(offset + reach)] = axis == 0   ? row(k + offset, j)
                                                         : axis == 1 ? row(k, j + offset)
                                                                     : line.data() + reach + offset;
      }
      f(Rows(rows), out.data() + (k * s.ny + j) * s.nx);
    }
  });
}

/// Computes the weights within three standard deviations.
std::vector<float> gaussian_weights(double sigma) {
  const auto reach = static_cast<Index>(std::ceil(3.0 * sigma));
  const auto height = [&](Index i) {
    return std::exp(-0.5 * static_cast<double>(i * i) / (sigma * sigma));
  };
  double sum = 0.0;
  for (Index i = -reach; i <= reach; ++i) {
    sum += height(i);
  }
  std::vector<float> weight;
  for (Index i = -reach; i <= reach; ++i) {
    weight.push_back(static_cast<float>(height(i) / sum));
  }
  return weight;
}

} // namespace

void blur(std::vector<float>& values, const Shape& shape, const std::array<double, 3>& cells) {
  std::vector<float> out(values.size());
  for (int axis = 0; axis < 3; ++axis) {
    const double sigma = cells[static_cast<std::size_t>(axis)];
    if (sigma <= 0.0) {
      continue;
    }
    const std::vector<float> weight = gaussian_weights(sigma);
    along(values, shape, axis, static_cast<Index>(weight.size() / 2), out,
          [&](Rows rows, float* to) { weighted(rows, weight.data(), shape.nx, to); });
    values.swap(out);
  }
}

void dilate(std::vector<float>& values, const Shape& shape, Index reach) {
  std::vector<float> out(values.size());
  for (int axis = 0; axis < 3; ++axis) {
    along(values, shape, axis, reach, out,
          [&](Rows rows, float* to) { largest(rows, shape.nx, to); });
    values.swap(out);
  }
}

} // namespace firetwin::flow
