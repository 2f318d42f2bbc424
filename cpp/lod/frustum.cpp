#include "lod/frustum.hpp"

#include <cmath>

namespace firetwin::lod {
namespace {

Vector rotated(const std::array<double, 9>& m, const Vector& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
          m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

} // namespace

Frustum::Frustum(const View& view) : position_(view.position), normal_{}, offset_{} {
  normal_[4] = rotated(view.to_world, {0.0, 0.0, -1.0});
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double half = axis == 0 ? view.half_width : view.half_height;
    const double length = view.orthographic ? 1.0 : std::hypot(1.0, half);
    for (std::size_t side = 0; side < 2; ++side) {
      Vector inwards{0.0, 0.0, view.orthographic ? 0.0 : -half / length};
      inwards[axis] = (side == 0 ? 1.0 : -1.0) / length;
      normal_[2 * axis + side] = rotated(view.to_world, inwards);
      offset_[2 * axis + side] = view.orthographic ? half : 0.0;
    }
  }
}

} // namespace firetwin::lod
