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

inline float upwind_share(float flux, float low, float high) {
  const float share = std::fabs(flux) / (flux > 0.0F ? low : high);
  return share < 1.0F ? share : 1.0F;
}

inline float slope(float ahead, float behind, float courant) {
  const float a = std::fabs(ahead), b = std::fabs(behind);
  const float smooth = ((2.0F - courant) * a + (1.0F + courant) * b) * (1.0F / 3.0F);
  const float bound = 2.0F * (a < b ? a : b);
  const float size = smooth < bound ? smooth : bound;
  return (ahead > 0.0F) == (behind > 0.0F) ? std::copysign(size, ahead) : 0.0F;
}

} // namespace

FIRETWIN_LANES
void scale_row(Index n, const float* __restrict from, float factor, float* __restrict out) {
  for (Index i = 0; i < n; ++i) {
    out[i] = from[i] * factor;
  }
}

FIRETWIN_LANES
void remaining_row(Index n, const float* __restrict mass, const float* __restrict in,
                   const float* __restrict out, float* __restrict left) {
  for (Index i = 0; i < n; ++i) {
    left[i] = mass[i] + (in[i] - out[i]);
  }
}

FIRETWIN_LANES
void mean_row(Index n, const float* __restrict a, const float* __restrict b,
              float* __restrict out) {
  for (Index i = 0; i < n; ++i) {
    out[i] = 0.5F * (a[i] + b[i]);
  }
}

FIRETWIN_LANES
void courant_row(Index n, const float* __restrict flux, const float* __restrict low,
                 const float* __restrict high, float* __restrict courant) {
  for (Index i = 0; i < n; ++i) {
    courant[i] = upwind_share(flux[i], low[i], high[i]);
  }
}

FIRETWIN_LANES
void face_row(Index n, const float* __restrict flux, const float* __restrict courant,
              const Stencil& q, float* __restrict value) {
  const float* __restrict low2 = q.low2;
  const float* __restrict low = q.low;
  const float* __restrict high = q.high;
  const float* __restrict high2 = q.high2;
  for (Index i = 0; i < n; ++i) {
    const float a = low2[i], b = low[i], c = high[i], d = high2[i], share = courant[i];
    const bool up = flux[i] > 0.0F;
    const float here = up ? b : c;
    const float ahead = (up ? c : b) - here;
    const float behind = here - (up ? a : d);
    value[i] = here + 0.5F * (1.0F - share) * slope(ahead, behind, share);
  }
}

FIRETWIN_LANES
void inverse_row(Index n, const float* __restrict mass, const float* __restrict in,
                 const float* __restrict out, float* __restrict inverse) {
  for (Index i = 0; i < n; ++i) {
    inverse[i] = 1.0F / (mass[i] + (in[i] - out[i]));
  }
}

FIRETWIN_LANES
void advect_row(Index n, const float* __restrict in, const float* __restrict out,
                const float* __restrict low, const float* __restrict high,
                const float* __restrict inverse, float* __restrict q) {
  for (Index i = 0; i < n; ++i) {
    const float here = q[i];
    const float there = here + (in[i] * (low[i] - here) - out[i] * (high[i] - here)) * inverse[i];
    q[i] = std::fabs(there) < negligible ? 0.0F : there;
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
void mixing_flux_row(Index n, const float* __restrict exchange, float factor,
                     const float* __restrict low, const float* __restrict high,
                     float* __restrict mixed) {
  for (Index i = 0; i < n; ++i) {
    mixed[i] = exchange[i] * factor * (high[i] - low[i]);
  }
}

FIRETWIN_LANES
void mix_row(Index n, const float* __restrict low, const float* __restrict high,
             const float* __restrict inverse, float* __restrict q) {
  for (Index i = 0; i < n; ++i) {
    q[i] += (high[i] - low[i]) * inverse[i];
  }
}

FIRETWIN_LANES
void rescale_row(Index n, const float* __restrict mass, const float* __restrict in,
                 const float* __restrict out, float base, float* __restrict q) {
  const float inverse = 1.0F / base;
  for (Index i = 0; i < n; ++i) {
    q[i] += q[i] * (((mass[i] - base) + (in[i] - out[i])) * inverse);
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

FIRETWIN_LANES
float min_ratio_row(Index n, const float* part, const float* whole) {
  float least[lanes];
  std::fill_n(least, lanes, part[0] / whole[0]);
  Index i = 0;
  for (; i + lanes <= n; i += lanes) {
    for (Index lane = 0; lane < lanes; ++lane) {
      const float share = part[i + lane] / whole[i + lane];
      least[lane] = share < least[lane] ? share : least[lane];
    }
  }
  for (; i < n; ++i) {
    const float share = part[i] / whole[i];
    least[0] = share < least[0] ? share : least[0];
  }
  return *std::min_element(least, least + lanes);
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
