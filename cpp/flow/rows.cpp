#include "flow/rows.hpp"

#include "base/clones.hpp"

#include <algorithm>
#include <cmath>

#define FIRETWIN_LANES FIRETWIN_CLONES("avx512f", "avx2")

namespace firetwin::flow {
namespace {

constexpr float nothing = 1e-20F; // below it, numbers lose their digits and processors their speed

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
void left_row(Index n, const float* __restrict mass, const float* __restrict in,
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
void carry_row(Index n, const float* __restrict in, const float* __restrict out,
               const float* __restrict low, const float* __restrict high,
               const float* __restrict inverse, float* __restrict q) {
  for (Index i = 0; i < n; ++i) {
    const float here = q[i];
    const float there = here + (in[i] * (low[i] - here) - out[i] * (high[i] - here)) * inverse[i];
    q[i] = std::fabs(there) < nothing ? 0.0F : there;
  }
}

FIRETWIN_LANES
void exchange_row(Index n, const float* __restrict a, const float* __restrict b, float factor,
                  float most, float* __restrict out) {
  for (Index i = 0; i < n; ++i) {
    const float air = 0.5F * (a[i] + b[i]) * factor;
    out[i] = air < most ? air : most;
  }
}

FIRETWIN_LANES
void mixed_row(Index n, const float* __restrict exchange, float factor, const float* __restrict low,
               const float* __restrict high, float* __restrict mixed) {
  for (Index i = 0; i < n; ++i) {
    mixed[i] = exchange[i] * factor * (high[i] - low[i]);
  }
}

FIRETWIN_LANES
void stir_row(Index n, const float* __restrict low, const float* __restrict high,
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
void descend_row(Index n, const float* __restrict high, const float* __restrict low, float scale,
                 float* __restrict q) {
  for (Index i = 0; i < n; ++i) {
    q[i] -= (high[i] - low[i]) * scale;
  }
}

FIRETWIN_LANES
void grow_old_row(Index n, const float* __restrict smoke, float dt, float oldest,
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
float most_row(Index n, const float* q) {
  constexpr Index lanes = 16;
  float most[lanes] = {};
  Index i = 0;
  for (; i + lanes <= n; i += lanes) {
    for (Index lane = 0; lane < lanes; ++lane) {
      const float size = std::fabs(q[i + lane]);
      most[lane] = size > most[lane] ? size : most[lane];
    }
  }
  for (; i < n; ++i) {
    const float size = std::fabs(q[i]);
    most[0] = size > most[0] ? size : most[0];
  }
  return *std::max_element(most, most + lanes);
}

FIRETWIN_LANES
float least_row(Index n, const float* q) {
  float least = q[0];
  for (Index i = 1; i < n; ++i) {
    least = q[i] < least ? q[i] : least;
  }
  return least;
}

double sum_row(Index n, const float* q) {
  double sum = 0.0;
  for (Index i = 0; i < n; ++i) {
    sum += static_cast<double>(q[i]);
  }
  return sum;
}

} // namespace firetwin::flow
