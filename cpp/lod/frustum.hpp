#pragma once

#include "base/vector.hpp"

#include <array>

namespace firetwin::lod {

/// The view volume of one camera in one frame, and the sun of that frame.
struct View {
  Vector position;                ///< camera, m
  std::array<double, 9> to_world; ///< rotation, row-major; the camera looks along its -z, y is up
  double half_width;              ///< perspective: tangent of half the horizontal angle of view
  double half_height;             ///< perspective: tangent of half the vertical angle of view
  bool orthographic;  ///< parallel projection: half_width and half_height are lengths, m
  bool above_terrain; ///< the camera is above the terrain; only then does terrain occlude
  Vector sun;         ///< unit vector to the sun; a zero vector casts no shadows
};

/// View frustum for frustum culling: four side planes and a near plane through the camera. It has
/// no far plane. An orthographic frustum is a box.
class Frustum {
public:
  explicit Frustum(const View& view);

  /// Sphere-plane test. The test is conservative: every bounding sphere that touches the frustum
  /// passes, and some spheres just outside an edge pass too.
  bool intersects(const Vector& centre, double radius) const {
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
  std::array<Vector, 5> normal_; ///< inward unit normals of the four sides and the near plane
  std::array<double, 5> offset_; ///< distance of each plane from the camera, outwards, m
};

} // namespace firetwin::lod
