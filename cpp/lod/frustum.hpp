#pragma once

#include "base/vector.hpp"

#include <array>

namespace firetwin::lod {

/// What one camera films in one frame.
struct View {
  Vector position;                ///< m
  std::array<double, 9> to_world; ///< rotation, row-major; the camera looks along its -z, y is up
  double across;                  ///< tangent of half the angle of view from left to right
  double along;                   ///< and from bottom to top
  bool parallel; ///< lines of sight do not meet in the camera: `across`, `along` are m instead
  bool clear;    ///< the camera is above the ground, which therefore can hide things from it
  Vector sun;    ///< unit vector towards it; anything else without shadows
};

/// The pyramid, or with parallel lines of sight the box, that a camera sees. It has no far end.
class Frustum {
public:
  explicit Frustum(const View& view);

  /// Whether any of the ball may be inside: true for every ball that touches it (and for some that
  /// lie just beside its edges).
  bool touches(const Vector& centre, double radius) const {
    const Vector to = minus(centre, position_);
    for (std::size_t i = 0; i < 5; ++i) {
      if (!(dot(to, normal_[i]) >= -(radius + offset_[i]))) {
        return false;
      }
    }
    return true;
  }

private:
  Vector position_;
  std::array<Vector, 5>
      normal_; ///< of its sides and of what is before the camera: inwards, length 1
  std::array<double, 5> offset_; ///< how far the sides are outside of the camera, m
};

} // namespace firetwin::lod
