#include "lod/frustum.hpp"

#include <cmath>

namespace firetwin::lod {
namespace {

Vector rotated(const std::array<double, 9>& m, const Vector& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
          m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

} // namespace

Frustum::Frustum(const View& view, double near, double far)
    : position_(view.position), forward_(rotated(view.to_world, {0.0, 0.0, -1.0})), near_(near),
      far_(far) {
  const double across = 0.5 * view.width;
  const double along = 0.5 * view.height;
  const std::array<Vector, 4> normals = {{{std::cos(across), 0.0, -std::sin(across)},
                                          {-std::cos(across), 0.0, -std::sin(across)},
                                          {0.0, std::cos(along), -std::sin(along)},
                                          {0.0, -std::cos(along), -std::sin(along)}}};
  for (std::size_t i = 0; i < 4; ++i) {
    normals_[i] = rotated(view.to_world, normals[i]);
  }
}

bool Frustum::touches(const Vector& centre, double radius) const {
  const Vector to = minus(centre, position_);
  const double depth = dot(to, forward_);
  bool inside = depth + radius >= near_ && depth - radius <= far_;
  for (const Vector& normal : normals_) {
    inside = inside && dot(to, normal) >= -radius;
  }
  return inside;
}

} // namespace firetwin::lod
