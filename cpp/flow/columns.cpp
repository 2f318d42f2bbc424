#include "flow/columns.hpp"

#include "base/catmull_rom.hpp"
#include "base/clones.hpp"
#include "base/interpolation.hpp"
#include "flow/parallel.hpp"

#include <algorithm>

namespace firetwin::flow {
namespace {

FIRETWIN_CLONES("avx512f", "avx2")
void mix_columns(const std::array<const float*, 4>& from, std::array<float, 2> part, Index n,
                 float* __restrict out) {
  const float *a = from[0], *b = from[1], *c = from[2], *d = from[3];
  const float north = part[0], east = part[1];
  for (Index k = 0; k < n; k += lanes) {
    for (Index l = k; l < k + lanes; ++l) {
      out[l] = lerp(lerp(a[l], b[l], east), lerp(c[l], d[l], east), north);
    }
  }
}

FIRETWIN_CLONES("avx512f", "avx2")
void add_row(const std::array<const float*, 4>& from, const std::array<float, 4>& weight, float row,
             Index n, float* __restrict out) {
  const float *a = from[0], *b = from[1], *c = from[2], *d = from[3];
  const auto [wa, wb, wc, wd] = weight;
  for (Index k = 0; k < n; k += lanes) {
    for (Index l = k; l < k + lanes; ++l) {
      out[l] += row * (a[l] * wa + b[l] * wb + c[l] * wc + d[l] * wd);
    }
  }
}

FIRETWIN_CLONES("avx512f", "avx2")
void mix_levels(const std::int32_t* __restrict low, const float* __restrict part, Index n,
                const float* __restrict levels, float* __restrict out) {
  for (Index i = 0; i < n; i += lanes) {
    for (Index l = i; l < i + lanes; ++l) {
      out[l] = lerp(levels[low[l]], levels[low[l] + 1], part[l]);
    }
  }
}

FIRETWIN_CLONES("avx512f", "avx2")
void curve_levels(const std::int32_t* __restrict low, const float* __restrict part, Index n,
                  const float* __restrict levels, float* __restrict out) {
  for (Index i = 0; i < n; i += lanes) {
    for (Index l = i; l < i + lanes; ++l) {
      const float* v = levels + low[l];
      const auto weight = catmull_rom(part[l]);
      out[l] = weight[0] * v[-1] + weight[1] * v[0] + weight[2] * v[1] + weight[3] * v[2];
    }
  }
}

/// Computes the cells around a position along an axis, and their weights.
void interpolation_weights(float at, Index count, std::array<Index, 2>& near, float& part,
                           std::array<Index, 4>& wide, std::array<float, 4>& weight) {
  const auto interval = interval_within(at, count);
  part = interval.part;
  near = {interval.low, interval.high};
  weight = catmull_rom(part);
  for (Index i = 0; i < 4; ++i) {
    wide[static_cast<std::size_t>(i)] = std::clamp(interval.low + i - 1, Index{0}, count - 1);
  }
}

} // namespace

ColumnStencil::ColumnStencil(float at_column, float at_row, const Shape& shape) {
  interpolation_weights(at_row, shape.ny, row, part[0], wide_row, row_weight);
  interpolation_weights(at_column, shape.nx, column, part[1], wide_column, column_weight);
}

Columns::Columns(const float* values, const Shape& shape, Index step)
    : shape_(shape), values_(shape.size() + lanes) {
  each(shape.ny, [&](Index row) {
    for (Index from = 0; from < shape.nx; from += lanes) { // small enough for the cache
      const Index to = std::min(from + lanes, shape.nx);
      for (Index k = 0; k < shape.nz; ++k) {
        const float* level = values + (k * shape.ny + row) * shape.nx * step;
        for (Index i = from; i < to; ++i) {
          values_[static_cast<std::size_t>((row * shape.nx + i) * shape.nz + k)] = level[i * step];
        }
      }
    }
  });
}

void Columns::linear(const ColumnStencil& at, Index first, Index last, float* out) const {
  std::array<const float*, 4> from{};
  for (std::size_t n = 0; n < 4; ++n) {
    from[n] = column(at.row[n / 2], at.column[n % 2]) + first;
  }
  mix_columns(from, at.part, last + 1 - first, out + first);
}

void Columns::cubic(const ColumnStencil& at, Index first, Index last, float* out) const {
  std::fill(out + first, out + first + whole_lanes(last + 1 - first), 0.0F);
  for (std::size_t j = 0; j < 4; ++j) {
    std::array<const float*, 4> from{};
    for (std::size_t i = 0; i < 4; ++i) {
      from[i] = column(at.wide_row[j], at.wide_column[i]) + first;
    }
    add_row(from, at.column_weight, at.row_weight[j], last + 1 - first, out + first);
  }
}

void linear_between(const LevelSamples& p, const float* levels, float* out) {
  mix_levels(p.low.data(), p.part.data(), p.count, levels, out);
}

void cubic_between(const LevelSamples& p, const float* levels, float* out) {
  curve_levels(p.low.data(), p.part.data(), p.count, levels, out);
}

} // namespace firetwin::flow
