#include "volume/flame_distance.hpp"

#include <cstddef>
#include <vector>

namespace firetwin::volume {
namespace {

using flames::FlameRay;
using flames::FlameSlab;
using flames::FlameVolume;
using flames::opaque_flames;

/// A slab, and the share of its light that reaches the eye.
struct SeenSlab {
  FlameSlab slab;
  float share;
};

float half_distance(const std::vector<SeenSlab>& slabs, float half) {
  for (const auto& [slab, share] : slabs) {
    const float step = (slab.to - slab.from) / static_cast<float>(lane_count);
    float before = 0.0F;
    for (std::size_t n = 0; n < lane_count; ++n) {
      if (share * slab.red[n] >= half) {
        const float part = (half - share * before) / (share * (slab.red[n] - before));
        return slab.from + step * (static_cast<float>(n) + part);
      }
      before = slab.red[n];
    }
    half -= share * before;
  }
  return slabs.back().slab.to;
}

} // namespace

void flame_distance(const FlameVolume& flames, const Rays& rays, float farthest,
                    std::span<float> out) {
  check(rays, {}, 0);
  for_rays(
      rays.size(), [] { return std::vector<SeenSlab>(); },
      [&](std::vector<SeenSlab>& slabs, std::size_t ray) {
        FlameRay burning(flames, rays.origin(ray), rays.direction(ray), farthest);
        FlameSlab slab;
        float transmittance = 1.0F, all = 0.0F;
        slabs.clear();
        while (transmittance >= opaque_flames && burning.next(farthest, farthest, slab)) {
          slabs.push_back({slab, transmittance});
          all += transmittance * slab.radiance[0];
          transmittance *= slab.transmittance;
        }
        out[2 * ray] = all > 0.0F ? half_distance(slabs, 0.5F * all) : 0.0F;
        out[2 * ray + 1] = all;
      });
}

} // namespace firetwin::volume
