#include "flow/filters.hpp"

#include "flow/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace firetwin::flow {
namespace {

/// out = f(rows), for every row of numbers along x, where `rows(offset)` is the row so many cells
/// along an axis, held inside. Along x itself, rows are shifted by copying.
template <class Function>
void along(std::vector<float>& values, const Shape& s, int axis, Index reach, const Function& f) {
  std::vector<float> out(values.size());
  each(s.nz, [&](Index k) {
    std::vector<float> line(static_cast<std::size_t>(s.nx + 2 * reach));
    for (Index j = 0; j < s.ny; ++j) {
      const auto row = [&](Index level, Index at) {
        return values.data() + (level * s.ny + at) * s.nx;
      };
      const float* here = row(k, j);
      if (axis == 2) {
        std::fill_n(line.begin(), reach, here[0]);
        std::copy_n(here, s.nx, line.begin() + reach);
        std::fill_n(line.begin() + reach + s.nx, reach, here[s.nx - 1]);
      }
      float* to = out.data() + (k * s.ny + j) * s.nx;
      for (Index offset = -reach; offset <= reach; ++offset) {
        const float* from = axis == 0   ? row(std::clamp(k + offset, Index{0}, s.nz - 1), j)
                            : axis == 1 ? row(k, std::clamp(j + offset, Index{0}, s.ny - 1))
                                        : line.data() + reach + offset;
        f(offset, s.nx, from, to);
      }
    }
  });
  values.swap(out);
}

} // namespace

void blur(std::vector<float>& values, const Shape& shape, const std::array<double, 3>& cells) {
  for (int axis = 0; axis < 3; ++axis) {
    const double sigma = cells[static_cast<std::size_t>(axis)];
    if (sigma <= 0.0) {
      continue;
    }
    const auto reach = static_cast<Index>(std::ceil(3.0 * sigma));
    std::vector<float> weight;
    double sum = 0.0;
    for (Index i = -reach; i <= reach; ++i) {
      sum += std::exp(-0.5 * static_cast<double>(i * i) / (sigma * sigma));
    }
    for (Index i = -reach; i <= reach; ++i) {
      weight.push_back(
          static_cast<float>(std::exp(-0.5 * static_cast<double>(i * i) / (sigma * sigma)) / sum));
    }
    along(values, shape, axis, reach, [&](Index offset, Index n, const float* from, float* to) {
      const float w = weight[static_cast<std::size_t>(offset + reach)];
      for (Index i = 0; i < n; ++i) {
        to[i] += w * from[i];
      }
    });
  }
}

void spread(std::vector<float>& values, const Shape& shape, Index reach) {
  for (int axis = 0; axis < 3; ++axis) {
    along(values, shape, axis, reach, [&](Index offset, Index n, const float* from, float* to) {
      for (Index i = 0; i < n; ++i) {
        to[i] = offset == -reach ? from[i] : std::max(to[i], from[i]);
      }
    });
  }
}

} // namespace firetwin::flow
