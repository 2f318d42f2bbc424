#include "volume/infrared.hpp"

#include "volume/optical_depth.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace firetwin::volume {
namespace {

/// Interpolates (rows, columns) linearly at a place; constant outside.
float field(std::span<const float> values, const AirTemperature& air,
            const std::array<double, 2>& place) {
  std::array<std::int64_t, 2> low{};
  std::array<float, 2> part{};
  for (std::size_t axis = 0; axis < 2; ++axis) { // x, y
    const std::int64_t count = air.shape[1 - axis];
    const double last = static_cast<double>(count - 1);
    const double at = std::clamp((place[axis] - air.corner[axis]) / air.spacing[axis], 0.0, last);
    low[axis] = std::clamp(static_cast<std::int64_t>(at), std::int64_t{0},
                           std::max(count - 2, std::int64_t{0}));
    part[axis] = static_cast<float>(at - static_cast<double>(low[axis]));
  }
  const auto value = [&](std::int64_t up, std::int64_t right) {
    const std::int64_t row = std::min(low[1] + up, air.shape[0] - 1);
    const std::int64_t column = std::min(low[0] + right, air.shape[1] - 1);
    return values[static_cast<std::size_t>(row * air.shape[1] + column)];
  };
  const float south = value(0, 0) + part[0] * (value(0, 1) - value(0, 0));
  const float north = value(1, 0) + part[0] * (value(1, 1) - value(1, 0));
  return south + part[1] * (north - south);
}

/// Returns the black-body radiance of the air at a place.
float radiance(const AirTemperature& air, const Vector& place) {
  const std::array<double, 2> flat{place[0], place[1]};
  const double above = place[2] - static_cast<double>(field(air.elevation, air, flat));
  const double kelvin = static_cast<double>(field(air.kelvin, air, flat)) - above * air.lapse;
  const double last = static_cast<double>(air.radiance.size() - 1);
  const double at = std::clamp((kelvin - air.coldest) / air.kelvin_step, 0.0, last);
  const auto low = std::min(static_cast<std::size_t>(at), air.radiance.size() - 2);
  const float part = static_cast<float>(at - static_cast<double>(low));
  return air.radiance[low] + part * (air.radiance[low + 1] - air.radiance[low]);
}

/// Returns the layer whose next segment is nearest; null if no segment is left.
LayerCrossing* nearest(std::vector<LayerCrossing>& crossings) {
  LayerCrossing* found = nullptr;
  for (LayerCrossing& each : crossings) {
    const bool left = each.current < each.segments.size();
    if (left && (found == nullptr ||
                 each.segments[each.current].from < found->segments[found->current].from)) {
      found = &each;
    }
  }
  return found;
}

/// Computes radiance and transmittance of the smoke and flames on a ray of length `end`.
std::array<float, 2> along(RayTraversal& traversal, FlameRay* flames, const Vector& origin,
                           const Vector& direction, float end, const AirTemperature& air,
                           double step) {
  float light = 0.0F, transmittance = 1.0F;
  const auto burn = [&](float until) {
    FlameSlab slab;
    while (flames != nullptr && flames->next(until, slab)) {
      light += transmittance * slab.infrared;
      transmittance *= slab.infrared_transmittance;
    }
  };
  // Layers overlap where they blend: segments are processed in order of distance.
  while (LayerCrossing* crossing = nearest(traversal.crossings())) {
    const Segment& segment = crossing->segments[crossing->current++];
    const double middle = traversal.entry() + 0.5 * static_cast<double>(segment.from + segment.to);
    burn(static_cast<float>(middle));
    const double depth = depth_of(*crossing, segment, step);
    const auto step_transmittance = static_cast<float>(std::exp(-depth * air.absorption));
    if (step_transmittance < 1.0F) {
      light += transmittance * (1.0F - step_transmittance) *
               radiance(air, {origin[0] + direction[0] * middle, origin[1] + direction[1] * middle,
                              origin[2] + direction[2] * middle});
      transmittance *= step_transmittance;
    }
  }
  burn(end);
  return {light, transmittance};
}

} // namespace

void march_infrared(Layers layers, const FlameVolume* flames, const Rays& rays,
                    std::span<const float> distances, const AirTemperature& air, double step,
                    std::span<float> out) {
  check(rays, distances, 1);
  const auto cells = static_cast<std::size_t>(air.shape[0] * air.shape[1]);
  if (cells < 1 || air.kelvin.size() != cells || air.elevation.size() != cells ||
      air.radiance.size() < 2) {
    throw std::invalid_argument(
        "kelvin and elevation must have the same shape, and radiance at least 2 values");
  }
  const BandRadiance band{air.radiance, air.coldest, air.kelvin_step};
  for_rays(
      rays.size(), [layers] { return RayTraversal(layers); },
      [&](RayTraversal& traversal, std::size_t ray) {
        const Vector origin = rays.origin(ray), direction = rays.direction(ray);
        const float end = distances[ray];
        if (!traversal.follow(origin, direction, static_cast<double>(end))) {
          for (LayerCrossing& each : traversal.crossings()) {
            each.segments.clear();
          }
        }
        std::optional<FlameRay> burning;
        if (flames != nullptr) {
          burning.emplace(*flames, origin, direction, end, ray, &band);
        }
        const auto [light, transmittance] =
            along(traversal, burning ? &*burning : nullptr, origin, direction, end, air, step);
        out[2 * ray] = light;
        out[2 * ray + 1] = transmittance;
      });
}

} // namespace firetwin::volume
