#include "volume/infrared.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace firetwin::volume {
namespace {

using flames::BandRadiance;
using flames::FlameRay;
using flames::FlameSlab;
using flames::FlameVolume;

constexpr float visible_smoke = 1.0e-3F; // 1/m; thinner smoke has less hot gas

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

/// Returns the air temperature at a place, K.
double kelvin_at(const AirTemperature& air, const Vector& place) {
  const std::array<double, 2> flat{place[0], place[1]};
  const double above = place[2] - static_cast<double>(field(air.elevation, air, flat));
  return static_cast<double>(field(air.kelvin, air, flat)) - above * air.lapse;
}

/// Returns the black-body radiance at a temperature (K).
float radiance(const AirTemperature& air, double kelvin) {
  const double last = static_cast<double>(air.radiance.size() - 1);
  const double at = std::clamp((kelvin - air.coldest) / air.kelvin_step, 0.0, last);
  const auto low = std::min(static_cast<std::size_t>(at), air.radiance.size() - 2);
  const float part = static_cast<float>(at - static_cast<double>(low));
  return air.radiance[low] + part * (air.radiance[low + 1] - air.radiance[low]);
}

/// Returns the excess temperature of hot gases at a place, K.
float excess_at(std::span<const HotGas> hot, const Vector& place) {
  for (std::size_t n = hot.size(); n-- > 0;) {
    if (const float found = hot[n].at(place); found > 0.0F) {
      return found;
    }
  }
  return 0.0F;
}

/// Smoke and gases that a ray meets.
struct InfraredMedium {
  const AirTemperature& air;
  const HotGases& hot;
  double step;
};

/// Adds the radiance of a segment; returns radiance and transmittance behind it.
std::array<float, 2> through(const LayerCrossing& crossing, const Segment& segment, double entry,
                             const Vector& origin, const Vector& direction,
                             const InfraredMedium& medium, std::array<float, 2> before) {
  auto [light, transmittance] = before;
  const float all = segment.to - segment.from;
  const int count = std::max(
      1, static_cast<int>(std::ceil(all / (static_cast<float>(medium.step) * crossing.voxel))));
  const float length = all / static_cast<float>(count);
  for (int s = 0; s < count; ++s) {
    const float at = segment.from + (static_cast<float>(s) + 0.5F) * length;
    const float smoke = density(segment.voxels, local(crossing, segment, at));
    if (smoke <= 0.0F) {
      continue;
    }
    const double way = entry + static_cast<double>(at);
    const Vector place{origin[0] + direction[0] * way, origin[1] + direction[1] * way,
                       origin[2] + direction[2] * way};
    const auto excess = static_cast<double>(excess_at(medium.hot.cells, place));
    const double absorption =
        static_cast<double>(smoke) * medium.air.absorption +
        medium.hot.absorption * excess * static_cast<double>(std::min(smoke / visible_smoke, 1.0F));
    const auto kept = static_cast<float>(std::exp(-absorption * static_cast<double>(length)));
    if (kept < 1.0F) {
      light += transmittance * (1.0F - kept) *
               radiance(medium.air, kelvin_at(medium.air, place) + excess);
      transmittance *= kept;
    }
  }
  return {light, transmittance};
}

/// Computes radiance and transmittance of the smoke, gases and flames on a ray of length `end`.
std::array<float, 2> along(RayTraversal& traversal, FlameRay* flames, const Vector& origin,
                           const Vector& direction, float end, const InfraredMedium& medium) {
  std::array<float, 2> found{0.0F, 1.0F};
  const auto burn = [&](float until) {
    FlameSlab slab;
    while (flames != nullptr && flames->next(until, end, slab)) {
      found[0] += found[1] * slab.infrared;
      found[1] *= slab.infrared_transmittance;
    }
  };
  // Layers overlap where they blend: segments are processed in order of distance.
  while (LayerCrossing* crossing = traversal.nearest()) {
    const Segment& segment = crossing->segments[crossing->current++];
    const double middle = traversal.entry() + 0.5 * static_cast<double>(segment.from + segment.to);
    burn(static_cast<float>(middle));
    found = through(*crossing, segment, traversal.entry(), origin, direction, medium, found);
  }
  burn(end);
  return found;
}

} // namespace

float HotGas::at(const Vector& place) const {
  std::array<std::int64_t, 2> low{}; // x, y
  std::array<float, 2> part{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double at = (place[axis] - first[axis]) / spacing;
    const std::int64_t last = shape[2 - axis] - 1;
    if (!(at >= 0.0 && at < static_cast<double>(last))) {
      return 0.0F;
    }
    low[axis] = static_cast<std::int64_t>(at);
    part[axis] = static_cast<float>(at - static_cast<double>(low[axis]));
  }
  const auto level = [&](std::span<const float> values, std::int64_t k) {
    const std::int64_t n = (k * shape[1] + low[1]) * shape[2] + low[0];
    const float* south = values.data() + n;
    const float* north = south + shape[2];
    const float a = south[0] + part[0] * (south[1] - south[0]);
    return a + part[1] * (north[0] + part[0] * (north[1] - north[0]) - a);
  };
  const auto height = static_cast<float>(place[2]);
  std::int64_t under = 0, over = shape[0] - 1;
  if (height >= level(heights, over)) {
    return 0.0F;
  }
  while (over - under > 1) {
    const std::int64_t middle = (under + over) / 2;
    (level(heights, middle) <= height ? under : over) = middle;
  }
  const float base = level(heights, under), top = level(heights, over);
  const float up = std::clamp((height - base) / (top - base), 0.0F, 1.0F);
  const float value = level(excess, under);
  return std::max(value + up * (level(excess, over) - value), 0.0F);
}

void march_infrared(Layers layers, const FlameVolume* flames, const Rays& rays,
                    std::span<const float> distances, const AirTemperature& air,
                    const HotGases& hot, double step, std::span<float> out) {
  check(rays, distances, 1);
  const auto cells = static_cast<std::size_t>(air.shape[0] * air.shape[1]);
  if (cells < 1 || air.kelvin.size() != cells || air.elevation.size() != cells ||
      air.radiance.size() < 2) {
    throw std::invalid_argument(
        "kelvin and elevation must have the same shape, and radiance at least 2 values");
  }
  const BandRadiance band{air.radiance, air.coldest, air.kelvin_step};
  for (const HotGas& each : hot.cells) {
    const auto count = static_cast<std::size_t>(each.shape[0] * each.shape[1] * each.shape[2]);
    if (std::min({each.shape[0], each.shape[1], each.shape[2]}) < 2 ||
        each.excess.size() != count || each.heights.size() != count) {
      throw std::invalid_argument(
          "excess and heights must have the same shape, of at least two cells along each axis");
    }
  }
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
          burning.emplace(*flames, origin, direction, end, &band);
        }
        const auto [light, transmittance] = along(traversal, burning ? &*burning : nullptr, origin,
                                                  direction, end, {air, hot, step});
        out[2 * ray] = light;
        out[2 * ray + 1] = transmittance;
      });
}

} // namespace firetwin::volume
