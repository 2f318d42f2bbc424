#include "volume/march.hpp"

#include "base/clones.hpp"
#include "base/simd.hpp"
#include "volume/half.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace firetwin::volume {
namespace {

constexpr float never = std::numeric_limits<float>::max();

using Four = Simd<float, 4>;

Four four(const Colour& colour, float factor = 1.0F) {
  return Four{colour[0], colour[1], colour[2], 0.0F} * factor;
}

/// What is the same for all steps of a ray.
struct Shade {
  Four fresh, old, sun, sky, glow, air;
  float spread = 0.0F; ///< light towards the eye, 1 where it goes everywhere alike
  float density, twice, thrice;
  float thin, thick_from, thick_more;
  bool glows;

  explicit Shade(const Illumination& light)
      : fresh(four(light.fresh)), old(four(light.old)),
        sun(four(light.sun, 0.25F / std::numbers::pi_v<float>)), sky(four(light.sky)),
        glow(four(light.glow)), air(four(light.air)), density(light.density),
        twice(light.multiple_scattering[0]), thrice(light.multiple_scattering[1]), thin(light.thin),
        thick_from(light.thick[0]), thick_more(1.0F / (light.thick[1] - light.thick[0])),
        glows(std::max({light.glow[0], light.glow[1], light.glow[2]}) > 0.0F) {}
};

/// What came so far.
struct Sum {
  Four light{0.0F, 0.0F, 0.0F, 0.0F};
  float through = 1.0F;
};

/// Steps of one length through the blocks that lie at the same place of a ray.
struct Steps {
  float from, length; ///< m
  int count;
  float haze, more_haze; ///< part of light that is haze at `from`, and how much more each m
};

__attribute__((always_inline)) inline void mix(const Lanes& a, const Lanes& b, float part,
                                               Lanes& out) {
  out = a + (b - a) * part;
}

/// All channels, linear between voxels: firetwin::trilinear, but of vectors, which functions for
/// several processors hand on by reference alone.
__attribute__((always_inline)) inline void sample(const Crossing& crossing, const Segment& segment,
                                                  float distance, Lanes& out) {
  constexpr std::size_t z = Bricks::channels, y = Bricks::wide * z, x = Bricks::wide * y;
  std::array<std::size_t, 3> low;
  std::array<float, 3> part;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float at = crossing.place[axis] + crossing.pace[axis] * distance - segment.corner[axis];
    const int whole = std::clamp(static_cast<int>(at), 0, static_cast<int>(Bricks::side) - 1);
    low[axis] = static_cast<std::size_t>(whole);
    part[axis] = at - static_cast<float>(whole);
  }
  const std::uint16_t* first = segment.voxels + low[0] * x + low[1] * y + low[2] * z;
  std::array<Lanes, 2> planes;
  for (std::size_t i = 0; i < 2; ++i) {
    std::array<Lanes, 2> rows;
    for (std::size_t j = 0; j < 2; ++j) {
      const std::uint16_t* at = first + i * x + j * y;
      Lanes a, b;
      from_halves(at, a);
      from_halves(at + z, b);
      mix(a, b, part[2], rows[j]);
    }
    mix(rows[0], rows[1], part[1], planes[i]);
  }
  mix(planes[0], planes[1], part[0], out);
}

/// Light that smoke gives to the eye for each optical depth.
__attribute__((always_inline)) inline Four radiance(const Lanes& v, const Shade& shade,
                                                    float haze) {
  const Four albedo = shade.old + (shade.fresh - shade.old) * v[1];
  const float thinner = v[2] * v[2];
  Four lit = albedo * (shade.thrice * v[2]) + shade.twice * thinner;
  lit = albedo * lit + thinner * thinner * shade.spread;
  lit = albedo * (lit * shade.sun + shade.sky * v[3]);
  if (shade.glows) {
    const float thick = std::clamp((v[0] - shade.thick_from) * shade.thick_more, 0.0F, 1.0F);
    lit += shade.glow * (v[4] * (shade.thin + (1.0F - shade.thin) * thick));
  }
  return lit + (shade.air - lit) * haze;
}

/// The layers that a ray is in.
struct Inside {
  std::array<const Crossing*, 4> crossing;
  std::array<const Segment*, 4> segment;
  std::size_t count = 0;
};

FIRETWIN_CLONES("avx2")
void add(const Inside& inside, const Steps& steps, const Shade& shade, float stop, Sum& sum) {
  for (int s = 0; s < steps.count && sum.through >= stop; ++s) {
    const float way = (static_cast<float>(s) + 0.5F) * steps.length;
    const float haze = steps.haze + steps.more_haze * way;
    for (std::size_t k = 0; k < inside.count; ++k) {
      Lanes v;
      sample(*inside.crossing[k], *inside.segment[k], steps.from + way, v);
      if (v[0] <= Bricks::min_extinction) {
        continue;
      }
      v[0] *= shade.density;
      const float kept = std::exp(-v[0] * steps.length);
      sum.light += radiance(v, shade, haze) * (sum.through * (1.0F - kept));
      sum.through *= kept;
    }
  }
}

/// Part of light that is haze between the eye and a place on a ray, as in `scene.haze`.
class Haze {
public:
  Haze(const Illumination& light, const Vector& origin, const Vector& direction)
      : extinction_(light.haze), height_(light.haze_height), start_(origin[2]),
        rise_(direction[2]) {}

  float at(double distance) const {
    const double low = (start_ + rise_ * distance) / height_;
    const double rise = -rise_ * distance / height_;
    const double mean = std::abs(rise) < 1.0e-3 ? 1.0 - 0.5 * rise : -std::expm1(-rise) / rise;
    return static_cast<float>(-std::expm1(-extinction_ * distance * std::exp(-low) * mean));
  }

private:
  double extinction_, height_, start_, rise_;
};

/// Follows rays one by one; one for each thread.
class Marcher {
public:
  Marcher(Layers layers, const Taps& taps, const Illumination& light, const MarchSettings& how)
      : way_(layers), taps_(taps), light_(light), how_(how), shade_(light), order_(taps.count) {}

  void ray(const Vector& origin, const Vector& direction, std::size_t number, float* out);

private:
  void sort_taps(std::size_t number);
  float find_inside(float t);
  void step(float t, float until, const Haze& haze);
  void record(float* out);

  RayTraversal way_;
  Taps taps_;
  const Illumination& light_;
  MarchSettings how_;
  Shade shade_;
  Inside inside_;
  Sum sum_;
  std::vector<std::size_t> order_; ///< of taps, the nearest first
  std::vector<float> ends_;        ///< their distances from the entry, in that order
  std::size_t next_ = 0;           ///< tap
};

void Marcher::sort_taps(std::size_t number) {
  const float* distances = taps_.distances.data() + number * taps_.count;
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(), [distances](std::size_t a, std::size_t b) {
    return distances[a] < distances[b];
  });
  next_ = 0;
}

/// Finds the layers at t. Returns up to where that stays so.
float Marcher::find_inside(float t) {
  constexpr float near = 1.0e-3F; // m
  float to = never;
  inside_.count = 0;
  for (Crossing& crossing : way_.crossings()) {
    const Segment* segment = crossing.reach(t);
    if (segment == nullptr) {
      continue;
    }
    if (segment->from <= t + near) {
      inside_.crossing[inside_.count] = &crossing;
      inside_.segment[inside_.count++] = segment;
      to = std::min(to, segment->to);
    } else {
      to = std::min(to, segment->from);
    }
  }
  return to;
}

void Marcher::step(float t, float until, const Haze& haze) {
  float finest = never;
  for (std::size_t k = 0; k < inside_.count; ++k) {
    finest = std::min(finest, inside_.crossing[k]->voxel);
  }
  const float all = until - t;
  const int count =
      std::max(1, static_cast<int>(std::ceil(all / (static_cast<float>(how_.step) * finest))));
  const double entry = way_.entry();
  const float near = haze.at(entry + static_cast<double>(t));
  const float far = haze.at(entry + static_cast<double>(until));
  add(inside_, {t, all / static_cast<float>(count), count, near, (far - near) / all}, shade_,
      static_cast<float>(how_.stop), sum_);
}

void Marcher::record(float* out) {
  float* mine = out + 4 * order_[next_++];
  for (int channel = 0; channel < 3; ++channel) {
    mine[channel] = sum_.light[channel];
  }
  mine[3] = sum_.through;
}

void Marcher::ray(const Vector& origin, const Vector& direction, std::size_t number, float* out) {
  sort_taps(number);
  sum_ = {};
  const float* distances = taps_.distances.data() + number * taps_.count;
  const double end = static_cast<double>(distances[order_.back()]);
  if (way_.follow(origin, direction, end)) {
    ends_.clear();
    for (const std::size_t tap : order_) {
      ends_.push_back(static_cast<float>(static_cast<double>(distances[tap]) - way_.entry()));
    }
    const double g = light_.anisotropy,
                 base = 1.0 + g * g - 2.0 * g * dot(direction, light_.sun_direction);
    shade_.spread = static_cast<float>((1.0 - g * g) / (base * std::sqrt(base)));
    const Haze haze(light_, origin, direction);
    float t = 0.0F;
    while (next_ < taps_.count && sum_.through > 0.0F) {
      const float to = find_inside(t);
      const float until = std::min(to, ends_[next_]);
      if (inside_.count > 0 && until > t) {
        step(t, until, haze);
      } else if (to == never) {
        break; // no smoke is left
      }
      if (static_cast<double>(sum_.through) < how_.stop) {
        sum_.light *= 1.0F / (1.0F - sum_.through);
        sum_.through = 0.0F;
      }
      t = std::max(t, until);
      while (next_ < taps_.count && ends_[next_] <= t) {
        record(out);
      }
    }
  }
  while (next_ < taps_.count) {
    record(out);
  }
}

} // namespace

void march(Layers layers, const Rays& rays, const Taps& taps, const Illumination& light,
           const MarchSettings& how, std::span<float> out) {
  check(rays, taps.distances, taps.count);
  if (layers.size() > Inside{}.crossing.size() || taps.count < 1) {
    throw std::invalid_argument("a march takes at most four layers, and one tap or more");
  }
  for_rays(
      rays.size(), [&] { return Marcher(layers, taps, light, how); },
      [&](Marcher& marcher, std::size_t ray) {
        marcher.ray(rays.origin(ray), rays.direction(ray), ray, out.data() + 4 * taps.count * ray);
      });
}

} // namespace firetwin::volume
