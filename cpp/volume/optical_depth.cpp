#include "volume/optical_depth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace firetwin::volume {

float depth_of(const LayerCrossing& crossing, const Segment& segment, double step) {
  const float all = segment.to - segment.from;
  const int count =
      std::max(1, static_cast<int>(std::ceil(all / (static_cast<float>(step) * crossing.voxel))));
  const float length = all / static_cast<float>(count);
  float sum = 0.0F;
  for (int s = 0; s < count; ++s) {
    const float at = segment.from + (static_cast<float>(s) + 0.5F) * length;
    sum += density(segment.voxels, local(crossing, segment, at));
  }
  return sum * length;
}

void optical_depth(Layers layers, const Rays& rays, std::span<const float> distances, double step,
                   float max_depth, std::span<float> out) {
  check(rays, distances, 1);
  for_rays(
      rays.size(), [layers] { return RayTraversal(layers); },
      [&](RayTraversal& traversal, std::size_t ray) {
        float sum = 0.0F;
        if (traversal.follow(rays.origin(ray), rays.direction(ray), distances[ray])) {
          for (const LayerCrossing& crossing : traversal.crossings()) {
            for (const Segment& segment : crossing.segments) {
              sum += sum < max_depth ? depth_of(crossing, segment, step) : 0.0F;
            }
          }
        }
        out[ray] = sum;
      });
}

void opaque_distance(Layers layers, const Rays& rays, double step, float depth,
                     std::span<float> out) {
  check(rays, {}, 0);
  constexpr float endless = std::numeric_limits<float>::infinity();
  for_rays(
      rays.size(), [layers] { return RayTraversal(layers); },
      [&](RayTraversal& traversal, std::size_t ray) {
        out[ray] = endless;
        float sum = 0.0F, reached = 0.0F;
        if (!traversal.follow(rays.origin(ray), rays.direction(ray), endless)) {
          return;
        }
        while (LayerCrossing* crossing = traversal.nearest()) {
          const Segment& segment = crossing->segments[crossing->current++];
          sum += depth_of(*crossing, segment, step);
          reached = std::max(reached, segment.to);
          if (sum >= depth) {
            out[ray] = static_cast<float>(traversal.entry()) + reached;
            return;
          }
        }
      });
}

} // namespace firetwin::volume
