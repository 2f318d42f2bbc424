#include "lod/sight.hpp"

#include <algorithm>

namespace firetwin::lod {
namespace {

constexpr double lowest_sun = 0.0175; // sine of one degree

} // namespace

bool Sight::counts(const Vector& centre, double radius) const {
  const auto seen = [&](const Vector& place, double reach) {
    return std::any_of(cameras.begin(), cameras.end(),
                       [&](const Frustum& camera) { return camera.touches(place, reach); });
  };
  if (cameras.empty() || seen(centre, radius)) {
    return true;
  }
  if (sun[2] < lowest_sun) {
    return false;
  }
  // Balls of 3/2 of the radius, one radius apart, hold the whole tube of the shadow.
  const double length = std::max(centre[2] + radius - floor, 0.0) / sun[2];
  for (double way = radius; way < length + radius; way += radius) {
    if (seen({centre[0] - way * sun[0], centre[1] - way * sun[1], centre[2] - way * sun[2]},
             1.5 * radius)) {
      return true;
    }
  }
  return false;
}

} // namespace firetwin::lod
