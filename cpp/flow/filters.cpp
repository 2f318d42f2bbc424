#include "flow/filters.hpp"

#include "base/clones.hpp"
#include "base/simd.hpp"
#include "flow/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace firetwin::flow {
namespace {

/// Rows of numbers round one, of the same length, from the first to the last.
using Rows = std::span<const float* const>;

using Wide = Simd<float, static_cast<std::size_t>(lanes)>;

/// Sums stay in registers while the rows are gone through: half the time of adding one whole row
/// after the other. The last two Wides overlap those before.
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

/// f(rows, to) for every row of numbers along x, where `rows` are those within `reach` cells along
/// an axis, held inside. Along x itself, rows are shifted by copying.
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

/// Weights of the cells within three standard deviations of one.
std::vector<float> bell(double sigma) {
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
    const std::vector<float> weight = bell(sigma);
    along(values, shape, axis, static_cast<Index>(weight.size() / 2), out,
          [&](Rows rows, float* to) { weighted(rows, weight.data(), shape.nx, to); });
    values.swap(out);
  }
}

void spread(std::vector<float>& values, const Shape& shape, Index reach) {
  std::vector<float> out(values.size());
  for (int axis = 0; axis < 3; ++axis) {
    along(values, shape, axis, reach, out,
          [&](Rows rows, float* to) { largest(rows, shape.nx, to); });
    values.swap(out);
  }
}

} // namespace firetwin::flow
