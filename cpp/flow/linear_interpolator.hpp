#pragma once

#include "flow/lattice.hpp"

#include <algorithm>
#include <array>

namespace firetwin::flow {

/// Linear interpolation between a and b.
inline float mix(float a, float b, float part) {
  return a + (b - a) * part;
}

/// Trilinear interpolation of values [nz][ny][nx][parts] at cell centres; constant outside.
template <std::size_t parts> class LinearInterpolator {
public:
  LinearInterpolator(Index nx, Index ny, Index nz, const float* values)
      : nx_(nx), ny_(ny), nz_(nz), values_(values) {}

  /// Values at fractional columns, rows and levels; 0 is the centre of the first cell.
  std::array<float, parts> at(float x, float y, float z) const {
    const Axis a(x, nx_), b(y, ny_), c(z, nz_);
    const auto stride = static_cast<Index>(parts);
    const float* corner = values_ + ((c.low * ny_ + b.low) * nx_ + a.low) * stride;
    const Index east = a.step * stride, north = b.step * nx_ * stride,
                up = c.step * ny_ * nx_ * stride;
    std::array<float, parts> result;
    for (std::size_t p = 0; p < parts; ++p) {
      const float* v = corner + p;
      const float front = mix(v[0], v[east], a.part), back = mix(v[north], v[north + east], a.part);
      v += up;
      const float over = mix(v[0], v[east], a.part),
                  beyond = mix(v[north], v[north + east], a.part);
      result[p] = mix(mix(front, back, b.part), mix(over, beyond, b.part), c.part);
    }
    return result;
  }

private:
  struct Axis {
    Axis(float at, Index count) {
      const float held = std::clamp(at, 0.0F, static_cast<float>(count - 1));
      low = std::min(static_cast<Index>(held), std::max(count - 2, Index{0}));
      part = held - static_cast<float>(low);
      step = count > 1 ? 1 : 0;
    }
    Index low, step;
    float part;
  };

  Index nx_, ny_, nz_;
  const float* values_;
};

} // namespace firetwin::flow
