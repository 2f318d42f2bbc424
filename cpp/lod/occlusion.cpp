#include "lod/occlusion.hpp"

#include <algorithm>
#include <cmath>

namespace firetwin::lod {
namespace {

constexpr double most_samples = 4096.0;

} // namespace

bool hidden(const Vector& camera, const Vector& centre, double radius,
            const geo::HeightField& ground) {
  const Vector way = minus(centre, camera);
  const double length = std::hypot(way[0], way[1]);
  const double slope = way[2] + radius;
  if (!(radius >= 0.0) || !std::isfinite(length + slope) || length <= radius ||
      camera[2] < ground.at(camera[0], camera[1])) {
    return false;
  }
  // Past the last t, the ball itself is reached.
  const double last = 1.0 - radius / length;
  const double samples =
      std::clamp(std::ceil(2.0 * length / ground.smallest_cell()), 1.0, most_samples);
  for (double i = 1.0; i <= samples; ++i) {
    const double t = last * i / samples;
    const double z = camera[2] + t * slope;
    if (z >= ground.highest()) {
      if (slope >= 0.0) {
        return false; // it only gets higher
      }
      continue;
    }
    if (ground.lowest(camera[0] + t * way[0], camera[1] + t * way[1], t * radius) > z) {
      return true;
    }
  }
  return false;
}

} // namespace firetwin::lod
