#pragma once

#include "base/interpolation.hpp"
#include "flow/lattice.hpp"

#include <array>

namespace firetwin::flow {

/// Trilinear interpolation of values [nz][ny][nx][parts] at cell centres; constant outside.
template <std::size_t parts> class LinearInterpolator {
public:
  LinearInterpolator(Index nx, Index ny, Index nz, const float* values)
      : nx_(nx), ny_(ny), nz_(nz), values_(values) {}

  /// Interpolates at fractional columns, rows and levels; 0 is the centre of the first cell.
  std::array<float, parts> at(float x, float y, float z) const {
    const auto a = interval_within(x, nx_), b = interval_within(y, ny_),
               c = interval_within(z, nz_);
    const auto stride = static_cast<Index>(parts);
    const float* first = values_ + ((c.low * ny_ + b.low) * nx_ + a.low) * stride;
    const Index east = (a.high - a.low) * stride, north = (b.high - b.low) * nx_ * stride,
                up = (c.high - c.low) * ny_ * nx_ * stride;
    std::array<float, parts> result;
    for (std::size_t p = 0; p < parts; ++p) {
      result[p] = trilinear([v = first + p, east, north,
                             up](int k, int j, int i) { return v[k * up + j * north + i * east]; },
                            c.part, b.part, a.part);
    }
    return result;
  }

private:
  Index nx_, ny_, nz_;
  const float* values_;
};

} // namespace firetwin::flow
