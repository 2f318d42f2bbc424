#pragma once

#include "base/vector.hpp"

#include <array>

namespace firetwin::lod {

/// One position of a camera on its path.
struct View {
  Vector position;                ///< m
  std::array<double, 9> to_world; ///< rotation, row-major; the camera looks along its -z, y is up
  double width;                   ///< whole angle of view across, radians, below pi
  double height;                  ///< whole angle of view from top to bottom
};

/// The pyramid that one perspective camera sees.
class Frustum {
public:
  /// @param near, far distances along the view, m
  Frustum(const View& view, double near, double far);

  /// Whether any of the ball may be inside: true for every ball that touches the pyramid (and for
  /// some that lie just beside its edges), false where anything is NaN.
  bool touches(const Vector& centre, double radius) const;

private:
  Vector position_;
  Vector forward_;
  std::array<Vector, 4> normals_; ///< of the sides, inwards, of length 1
  double near_;
  double far_;
};

} // namespace firetwin::lod
