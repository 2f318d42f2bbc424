#include "flow/rows.hpp"

#include "base/clones.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#define FIRETWIN_LANES FIRETWIN_CLONES("avx512f", "avx2")

namespace firetwin::flow {
namespace {

constexpr float negligible = 1e-20F; // flushed to 0: near-denormal numbers lose digits and are slow

/// Face value between b and c, next to a and d: the upwind value plus half of a limited slope.
inline float face_value(bool up, float courant, float a, float b, float c, float d) {
  const float across = c - b, behind = up ? b - a : d - c;
  const float x = std::fabs(across), y = std::fabs(behind);
  const float smooth = ((2.0F - courant) * x + (1.0F + courant) * y) * (0.5F / 3.0F);
  const float bound = x < y ? x : y;
  const float half = smooth < bound ? smooth : bound;
  const bool monotone =
      (std::bit_cast<std::int32_t>(across) ^ std::bit_cast<std::int32_t>(behind)) >= 0;
  const float rise = (1.0F - courant) * (monotone ? std::copysign(half, across) : 0.0F);
  return up ? b + rise : c - rise;
}

/// Mean of a pair, or its one row.
template <bool staggered> inline float mean(const float* a, const float* b, Index i) {
  return staggered ? 0.5F * (a[i] + b[i]) : a[i];
}

template <bool staggered>
[[gnu::always_inline]] inline void face(Index n, const AirRows& rows, const Pair& exchange,
                                        float mixing, const Stencil& q, const FaceRows& faces) {
  const auto [in_a, in_b] = rows.flux_before;
  const auto [out_a, out_b] = rows.flux;
  const auto [low_a, low_b] = rows.mass_before;
  const auto [high_a, high_b] = rows.mass;
  const auto [low2, low, high, high2] = q;
  const auto [flux, inverse, value, mixed] = faces;
  n = whole_lanes(n);
#pragma GCC ivdep
  for (Index i = 0; i < n; ++i) {
    const float in = mean<staggered>(in_a, in_b, i), out = mean<staggered>(out_a, out_b, i);
    const float before = mean<staggered>(low_a, low_b, i);
    const bool up = out > 0.0F;
    const float share = std::fabs(out) / (up ? before : mean<staggered>(high_a, high_b, i));
    const float courant = share < 1.0F ? share : 1.0F;
    inverse[i] = 1.0F / (before + (in - out));
    if (staggered) {
      flux[i] = out;
    }
    const float b = low[i], c = high[i];
    value[i] = face_value(up, courant, low2[i], b, c, high2[i]);
    mixed[i] = mean<staggered>(exchange.a, exchange.b, i) * mixing * (c - b);
  }
}

template <bool rescales>
[[gnu::always_inline]] inline void update(Index n, const CellRows& rows, float* __restrict q) {
  const auto [in, out, low, high, mixed_low, mixed_high, inverse, mass, rest] = rows;
  const float inverse_rest = 1.0F / rest;
#pragma GCC ivdep
  for (Index i = 0; i < n; ++i) {
    const float here = q[i];
    float there = here + (in[i] * (low[i] - here) - out[i] * (high[i] - here)) * inverse[i];
    there = std::fabs(there) < negligible ? 0.0F : there;
    there += (mixed_high[i] - mixed_low[i]) * inverse[i];
    if (rescales) {
      there += there * (((mass[i] - rest) + (in[i] - out[i])) * inverse_rest);
    }
    q[i] = there;
  }
}

} // namespace

FIRETWIN_LANES
void scale_row(Index n, const float* __restrict from, float factor, float* __restrict out) {
  for (Index i = 0; i < n; ++i) {
    out[i] = from[i] * factor;
  }
}

FIRETWIN_LANES
void face_row(Index n, const AirRows& air, const Pair& exchange, float mixing, const Stencil& q,
              const FaceRows& faces) {
  if (air.flux.a == air.flux.b) {
    face<false>(n, air, exchange, mixing, q, faces);
  } else {
    face<true>(n, air, exchange, mixing, q, faces);
  }
}

FIRETWIN_LANES
void update_row(Index n, const CellRows& cells, float* q) {
  const Index all = whole_lanes(n);
  float kept[lanes];
  std::copy_n(q + all - lanes, lanes, kept);
  if (cells.mass) {
    update<true>(all, cells, q);
  } else {
    update<false>(all, cells, q);
  }
  std::copy(kept + lanes - (all - n), kept + lanes, q + n);
}

FIRETWIN_LANES
void drain_row(Index n, const std::array<const float*, 2>& in,
               const std::array<const float*, 2>& out, float rest, float* __restrict first,
               float* __restrict second, KeptAir& kept) {
  const float* __restrict in1 = in[0], * __restrict in2 = in[1];
  const float* __restrict out1 = out[0], * __restrict out2 = out[1];
  const Index all = whole_lanes(n);
#pragma GCC ivdep
  for (Index i = 0; i < all; ++i) {
    first[i] = rest + (in1[i] - out1[i]);
    second[i] = first[i] + (in2[i] - out2[i]);
  }
  std::fill(first + n, first + all, rest);
  std::fill(second + n, second + all, rest);
  for (Index i = 0; i < all; i += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const float once = first[i + static_cast<Index>(lane)],
                  twice = second[i + static_cast<Index>(lane)];
      const float share = twice / once;
      kept.least_first[lane] = once < kept.least_first[lane] ? once : kept.least_first[lane];
      kept.least_second[lane] = share < kept.least_second[lane] ? share : kept.least_second[lane];
      kept.most_second[lane] = twice > kept.most_second[lane] ? twice : kept.most_second[lane];
    }
  }
}

FIRETWIN_LANES
void exchange_row(Index n, const std::array<const float*, 2>& strength,
                  const std::array<const float*, 4>& air, float factor, float most,
                  float* __restrict out) {
  const float* __restrict a = strength[0], * __restrict b = strength[1];
  const float* __restrict c = air[0], * __restrict d = air[1];
  const float* __restrict e = air[2], * __restrict f = air[3];
  for (Index i = 0; i < n; ++i) {
    const float cd = c[i] < d[i] ? c[i] : d[i], ef = e[i] < f[i] ? e[i] : f[i];
    const float bound = most * (cd < ef ? cd : ef), mixed = 0.5F * (a[i] + b[i]) * factor;
    out[i] = mixed < bound ? mixed : bound;
  }
}

FIRETWIN_LANES
void divergence_row(Index n, const Faces& faces, float across, float above, float below,
                    float* __restrict out) {
  const float* __restrict left = faces.left;
  const float* __restrict right = faces.right;
  const float* __restrict front = faces.front;
  const float* __restrict back = faces.back;
  const float* __restrict under = faces.below;
  const float* __restrict over = faces.above;
  for (Index i = 0; i < n; ++i) {
    out[i] = ((right[i] - left[i]) + (back[i] - front[i])) * across +
             (over[i] * above - under[i] * below);
  }
}

FIRETWIN_LANES
void subtract_gradient_row(Index n, const float* __restrict high, const float* __restrict low,
                           float scale, float* __restrict q) {
  for (Index i = 0; i < n; ++i) {
    q[i] -= (high[i] - low[i]) * scale;
  }
}

FIRETWIN_LANES
void age_row(Index n, const float* __restrict smoke, float dt, float oldest,
             float* __restrict age) {
  for (Index i = 0; i < n; ++i) {
    const float older = age[i] + smoke[i] * dt, most = smoke[i] * oldest;
    age[i] = older < most ? older : most;
  }
}

FIRETWIN_LANES
void relax_row(Index n, float target, const float* __restrict weight, float share,
               float* __restrict q) {
  for (Index i = 0; i < n; ++i) {
    q[i] += (target - q[i]) * (weight[i] * share);
  }
}

FIRETWIN_LANES
void relax_row(Index n, const float* __restrict target, const float* __restrict weight, float share,
               float* __restrict q) {
  for (Index i = 0; i < n; ++i) {
    q[i] += (target[i] - q[i]) * (weight[i] * share);
  }
}

FIRETWIN_LANES
void relax_row(Index n, const float* __restrict target, float share, float* __restrict q) {
  for (Index i = 0; i < n; ++i) {
    q[i] += (target[i] - q[i]) * share;
  }
}

FIRETWIN_LANES
float max_abs_row(Index n, const float* q) { // magnitudes sort like their bits
  std::int32_t most = 0;
  for (Index i = 0; i < n; ++i) {
    const std::int32_t size = std::bit_cast<std::int32_t>(q[i]) & 0x7fffffff;
    most = size > most ? size : most;
  }
  return std::bit_cast<float>(most);
}

FIRETWIN_LANES
bool has_nonzero_row(Index n, const float* q) {
  std::int32_t bits = 0;
  for (Index i = 0; i < n; ++i) {
    bits |= std::bit_cast<std::int32_t>(q[i]);
  }
  return (bits & 0x7fffffff) != 0;
}

double sum_row(Index n, const float* q) {
  double sum[8] = {};
  Index i = 0;
  for (; i + 8 <= n; i += 8) {
    for (Index lane = 0; lane < 8; ++lane) {
      sum[lane] += static_cast<double>(q[i + lane]);
    }
  }
  for (; i < n; ++i) {
    sum[0] += static_cast<double>(q[i]);
  }
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

} // namespace firetwin::flow
