#include "volume/march.hpp"

#include "base/clones.hpp"
#include "base/simd.hpp"
#include "base/smoothstep.hpp"
#include "flames/flames.hpp"
#include "volume/fine_detail.hpp"
#include "volume/half.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>

namespace firetwin::volume {
namespace {

using flames::FlameRay;
using flames::FlameSlab;
using flames::FlameVolume;

constexpr float no_limit = std::numeric_limits<float>::max();
constexpr float outline_pixels = 1.5F; // width of an outline, half as many voxels as it is painted
constexpr float max_sharpness = 4.0F;
constexpr float outline_range = 0.5F;  // of sharpness over 1, in which outlines fade in
constexpr float finest_noise = 4.0F;   // pixels, wavelength of the finest noise
constexpr float noise_step = 0.4F;     // steps relative to that wavelength
constexpr float shortest_step = 0.06F; // voxels
constexpr float faint = 0.03F;         // transmittance below which noise is not visible

using Four = Simd<float, 4>;

Four four(const Colour& colour, float factor = 1.0F) {
  return Four{colour[0], colour[1], colour[2], 0.0F} * factor;
}

/// Constants of a ray's shading.
struct ShadingConstants {
  Four fresh, old, sun, sky, glow;
  float phase = 0.0F; ///< phase function towards the eye; isotropic: 1
  float density, twice, thrice;
  float thin;
  bool glows;

  explicit ShadingConstants(const Illumination& light)
      : fresh(four(light.fresh)), old(four(light.old)),
        sun(four(light.sun, 0.25F / std::numbers::pi_v<float>)), sky(four(light.sky)),
        glow(four(light.glow)), density(light.density), twice(light.multiple_scattering[0]),
        thrice(light.multiple_scattering[1]), thin(light.thin),
        glows(std::max({light.glow[0], light.glow[1], light.glow[2]}) > 0.0F) {}
};

/// Radiance and transmittance accumulated along the ray.
struct RayState {
  Four radiance{0.0F, 0.0F, 0.0F, 0.0F};
  float transmittance = 1.0F;
  Four flames{0.0F, 0.0F, 0.0F, 0.0F}; ///< share of flames in the radiance
  float smoke_transmittance = 1.0F;    ///< without flames

  /// Ends the ray: extrapolates its radiance to a transmittance of 0.
  void end() {
    const float rest = 1.0F / (1.0F - transmittance);
    radiance *= rest;
    flames *= rest;
    transmittance = 0.0F;
  }
};

/// Haze between the eye and a point on a ray.
struct HazeState {
  float share; ///< of haze in the radiance, 0 to 1
  Four light;  ///< radiance of the haze in front of an opaque object
};

using SampleHaze = std::array<HazeState, SampleRow{}.size()>;

/// Equal steps through blocks that overlap along the ray.
struct Steps {
  float from, length; ///< m
  int count;
  HazeState haze, haze_slope; ///< at `from`, and its increase per m
};

__attribute__((always_inline)) inline void blend(const Lanes& a, const Lanes& b, float part,
                                                 Lanes& out) {
  out = a + (b - a) * part;
}

/// Interpolates all channels linearly between voxels, like firetwin::trilinear but for vectors,
/// which cloned functions must pass by reference.
__attribute__((always_inline)) inline void
sample(const LayerCrossing& crossing, const Segment& segment, float distance, Lanes& out) {
  constexpr std::size_t z = Bricks::channels, y = Bricks::wide * z, x = Bricks::wide * y;
  std::array<std::size_t, 3> low;
  std::array<float, 3> part;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float at = crossing.index_origin[axis] + crossing.index_direction[axis] * distance -
                     segment.corner[axis];
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
      blend(a, b, part[2], rows[j]);
    }
    blend(rows[0], rows[1], part[1], planes[i]);
  }
  blend(planes[0], planes[1], part[0], out);
}

/// Returns the radiance of smoke towards the eye per unit of optical depth.
__attribute__((always_inline)) inline Four radiance(const Lanes& v, const ShadingConstants& shading,
                                                    const HazeState& haze) {
  const Four albedo = shading.old + (shading.fresh - shading.old) * v[1];
  const float sun_root = v[2] * v[2];
  Four lit = albedo * (shading.thrice * v[2]) + shading.twice * sun_root;
  lit = albedo * lit + sun_root * sun_root * shading.phase;
  lit = albedo * (lit * shading.sun + shading.sky * v[3]);
  if (shading.glows) {
    lit += albedo * shading.glow * (v[4] * (1.0F - (1.0F - shading.thin) * v[3]));
  }
  return lit * (1.0F - haze.share) + haze.light;
}

/// Layers with smoke at the current position of the ray.
struct ActiveLayers {
  static constexpr std::size_t most = 4;
  std::array<const LayerCrossing*, most> crossing;
  std::array<const Segment*, most> segment;
  std::array<FineDetail, most> detail;
  std::size_t count = 0;
  float pixel = 0.0F, pixel_slope = 0.0F; ///< m at the ray's entry, and per m; 0: no detail

  /// Returns the wavelength of the finest noise at a distance, m.
  float finest(float distance) const {
    const float size = pixel + pixel_slope * distance;
    return size > 0.0F ? finest_noise * size : no_limit;
  }
  /// Returns the sharpness of a layer's outlines at a distance.
  float sharpness(std::size_t layer, float distance) const {
    const float size = pixel + pixel_slope * distance;
    return size > 0.0F
               ? std::clamp(crossing[layer]->voxel / (outline_pixels * size), 1.0F, max_sharpness)
               : 1.0F;
  }
};

constexpr std::size_t row_size = SampleRow{}.size();

/// Extinction and radiance of one layer at a row of samples.
struct LayerRow {
  std::array<float, row_size> extinction;
  std::array<Four, row_size> light;
};

/// Samples a layer at a row of distances; `count` of them are used. Samples have noise if `clear`.
FIRETWIN_CLONES("avx2")
void sample_row(const ActiveLayers& active, std::size_t layer, const SampleRow& distances,
                const SampleHaze& haze, std::size_t count, bool clear,
                const ShadingConstants& shading, LayerRow& out) {
  std::array<Lanes, row_size> values;
  bool noisy = false;
  for (std::size_t n = 0; n < count; ++n) {
    sample(*active.crossing[layer], *active.segment[layer], distances[n], values[n]);
    noisy = noisy || values[n][0] > Bricks::min_extinction;
  }
  SampleRow noise{};
  if (noisy && clear && active.detail[layer].shows(active.finest(distances[0]))) {
    SampleRow finest;
    std::transform(distances.begin(), distances.end(), finest.begin(),
                   [&](float distance) { return active.finest(distance); });
    active.detail[layer].at(distances, finest, noise);
  }
  for (std::size_t n = 0; n < count; ++n) {
    Lanes& v = values[n];
    out.extinction[n] = 0.0F;
    if (v[0] <= Bricks::min_extinction) {
      continue;
    }
    const float sharpness = active.sharpness(layer, distances[n]);
    if (sharpness > 1.0F) {
      const float shown = std::min((sharpness - 1.0F) / outline_range, 1.0F);
      v[0] = Outline{v[5], v[6], v[7]}.extinction(v[0], noise[n], sharpness, shown);
    }
    out.extinction[n] = shading.density * v[0];
    out.light[n] = radiance(v, shading, haze[n]);
  }
}

void accumulate(const ActiveLayers& active, const Steps& steps, const ShadingConstants& shading,
                float min_transmittance, RayState& state) {
  std::array<LayerRow, ActiveLayers::most> layers;
  const auto all = static_cast<std::size_t>(steps.count);
  for (std::size_t first = 0; first < all && state.transmittance >= min_transmittance;
       first += row_size) {
    const std::size_t count = std::min(row_size, all - first);
    SampleRow distances;
    SampleHaze haze;
    for (std::size_t n = 0; n < row_size; ++n) {
      const float offset = (static_cast<float>(first + n) + 0.5F) * steps.length;
      distances[n] = steps.from + offset;
      haze[n] = {steps.haze.share + steps.haze_slope.share * offset,
                 steps.haze.light + steps.haze_slope.light * offset};
    }
    for (std::size_t k = 0; k < active.count; ++k) {
      sample_row(active, k, distances, haze, count, state.transmittance > faint, shading,
                 layers[k]);
    }
    for (std::size_t n = 0; n < count && state.transmittance >= min_transmittance; ++n) {
      for (std::size_t k = 0; k < active.count; ++k) {
        const float extinction = layers[k].extinction[n];
        if (extinction <= 0.0F) {
          continue;
        }
        const float step_transmittance = std::exp(-extinction * steps.length);
        state.radiance += layers[k].light[n] * (state.transmittance * (1.0F - step_transmittance));
        state.transmittance *= step_transmittance;
        state.smoke_transmittance *= step_transmittance;
      }
    }
  }
}

/// Haze along a ray, the same as on surfaces (`scene.haze`).
class Haze {
public:
  Haze(const Illumination& light, const Vector& origin, const Vector& direction)
      : light_(light), start_(origin[2]), rise_(direction[2]) {}

  HazeState at(double distance) const {
    double depth = 0.0;
    for (std::size_t layer = 0; layer < light_.haze.size(); ++layer) {
      const double height = light_.haze_height[layer];
      const double low = (start_ + rise_ * distance) / height;
      const double rise = -rise_ * distance / height;
      const double mean = std::abs(rise) < 1.0e-3 ? 1.0 - 0.5 * rise : -std::expm1(-rise) / rise;
      depth += light_.haze[layer] * distance * std::exp(-low) * mean;
    }
    const auto share = static_cast<float>(-std::expm1(-depth));
    const float thick =
        smoothstep(light_.thick_haze[0], light_.thick_haze[1], static_cast<float>(depth));
    const Four air = four(light_.air);
    return {share, (air + (four(light_.horizon) - air) * thick) * share};
  }

private:
  const Illumination& light_;
  double start_, rise_;
};

/// Marches rays one by one; use one object per thread.
class Marcher {
public:
  Marcher(Layers layers, const FlameVolume* flames, const Taps& taps, const Illumination& light,
          const MarchSettings& settings)
      : traversal_(layers), flames_(flames), taps_(taps), light_(light), settings_(settings),
        values_(march_values(settings.parts)), shading_(light), order_(taps.count) {}

  void ray(const Vector& origin, const Vector& direction, std::size_t number, float* out);

private:
  void sort_taps(std::size_t number);
  float find_active_layers(float t);
  float prepare(float t, float until);
  void step(float t, float until, const Haze& haze);
  float pass(float t, float until, const Haze& haze);
  const FlameSlab* flames_before(float until);
  void add(const FlameSlab& slab, const HazeState& haze);
  bool is_opaque() const {
    return static_cast<double>(state_.transmittance) < settings_.min_transmittance;
  }
  void record(float* out);

  RayTraversal traversal_;
  const FlameVolume* flames_; ///< may be null
  std::optional<FlameRay> burning_;
  std::optional<FlameSlab> slab_; ///< the next flames, in a later block
  double entry_ = 0.0;            ///< m, where distances of steps count from
  Taps taps_;
  const Illumination& light_;
  MarchSettings settings_;
  std::size_t values_; ///< of each tap in the result
  ShadingConstants shading_;
  ActiveLayers active_;
  RayState state_;
  std::vector<std::size_t> order_; ///< taps, nearest first
  std::vector<float> ends_;        ///< distances of the taps from the entry, in that order
  std::size_t next_ = 0;           ///< next tap
};

void Marcher::sort_taps(std::size_t number) {
  const float* distances = taps_.distances.data() + number * taps_.count;
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(), [distances](std::size_t a, std::size_t b) {
    return distances[a] < distances[b];
  });
  next_ = 0;
}

/// Finds the layers at t; returns the distance up to which they stay the same.
float Marcher::find_active_layers(float t) {
  constexpr float near = 1.0e-3F; // m
  float to = no_limit;
  active_.count = 0;
  for (LayerCrossing& crossing : traversal_.crossings()) {
    const Segment* segment = crossing.advance_to(t);
    if (segment == nullptr) {
      continue;
    }
    if (segment->from <= t + near) {
      active_.crossing[active_.count] = &crossing;
      active_.segment[active_.count++] = segment;
      to = std::min(to, segment->to);
    } else {
      to = std::min(to, segment->from);
    }
  }
  return to;
}

/// Prepares the outlines and noise of the active layers; returns the length of steps, m.
float Marcher::prepare(float t, float until) {
  active_.pixel = static_cast<float>(settings_.pixel[0] + settings_.pixel[1] * entry_);
  active_.pixel_slope = static_cast<float>(settings_.pixel[1]);
  const float finest = active_.finest(0.5F * (t + until));
  float length = no_limit;
  for (std::size_t k = 0; k < active_.count; ++k) {
    const float voxel = active_.crossing[k]->voxel;
    length = std::min(length, static_cast<float>(settings_.step) * voxel);
    const NoiseFrame* noise = active_.crossing[k]->noise;
    if (noise != nullptr && noise->size > active_.finest(t)) {
      active_.detail[k] = FineDetail(*active_.crossing[k], *active_.segment[k], t, until);
      length = std::min(length, std::max(noise_step * finest, shortest_step * voxel));
    } else {
      active_.detail[k] = FineDetail();
    }
  }
  return length;
}

void Marcher::step(float t, float until, const Haze& haze) {
  const float all = until - t;
  const int count = std::max(1, static_cast<int>(std::ceil(all / prepare(t, until))));
  const HazeState near = haze.at(entry_ + static_cast<double>(t));
  const HazeState far = haze.at(entry_ + static_cast<double>(until));
  const HazeState slope{(far.share - near.share) / all, (far.light - near.light) * (1.0F / all)};
  accumulate(active_, {t, all / static_cast<float>(count), count, near, slope}, shading_,
             static_cast<float>(settings_.min_transmittance), state_);
}

/// Adds flames to the end of the ray.
void Marcher::add(const FlameSlab& slab, const HazeState& haze) {
  const Four light{slab.radiance[0], slab.radiance[1], slab.radiance[2], 0.0F};
  const Four seen = light * (1.0F - haze.share) + haze.light * (1.0F - slab.transmittance);
  state_.radiance += seen * state_.transmittance;
  state_.flames += seen * state_.transmittance;
  state_.transmittance *= slab.transmittance;
  if (state_.transmittance < flames::opaque_flames) { // the rest is extrapolated
    state_.end();
  }
}

/// Returns the next slab of flames, which begins before `until` and does not reach beyond the next
/// tap; null if there is none.
const FlameSlab* Marcher::flames_before(float until) {
  const auto distance = [this](float t) {
    return static_cast<float>(entry_ + static_cast<double>(t));
  };
  if (!slab_ && burning_) {
    FlameSlab found;
    if (burning_->next(distance(until), distance(ends_[next_]), found)) {
      slab_ = found;
    }
  }
  return slab_ ? &*slab_ : nullptr;
}

/// Marches smoke and flames between t and `until`, or beyond it to the end of the last flames;
/// returns where it ends. Each slab of flames is at its middle, and the part of it that burns has
/// no smoke: soot there glows, and is in the extinction of the flames.
float Marcher::pass(float t, float until, const Haze& haze) {
  while (const FlameSlab* slab = is_opaque() ? nullptr : flames_before(until)) {
    const double middle = 0.5 * static_cast<double>(slab->from + slab->to);
    const auto here = static_cast<float>(middle - entry_);
    const float half = 0.5F * slab->share * (slab->to - slab->from);
    if (here - half >= until && until < ends_[next_]) {
      break;
    }
    const float before = std::clamp(here - half, t, std::max(t, until));
    if (active_.count > 0 && before > t) {
      step(t, before, haze);
    }
    add(*slab, haze.at(middle));
    slab_.reset();
    t = std::clamp(here + half, before, std::max(before, ends_[next_]));
  }
  if (active_.count > 0 && until > t) {
    step(t, until, haze);
  }
  return std::max(t, until);
}

void Marcher::record(float* out) {
  float* mine = out + values_ * order_[next_++];
  for (int channel = 0; channel < 3; ++channel) {
    mine[channel] = state_.radiance[channel];
  }
  mine[3] = state_.transmittance;
  if (values_ == march_values(true)) {
    for (int channel = 0; channel < 3; ++channel) {
      mine[4 + channel] = state_.flames[channel];
    }
    mine[7] = state_.smoke_transmittance;
  }
}

void Marcher::ray(const Vector& origin, const Vector& direction, std::size_t number, float* out) {
  sort_taps(number);
  state_ = {};
  const float* distances = taps_.distances.data() + number * taps_.count;
  const double end = static_cast<double>(distances[order_.back()]);
  bool smoky = traversal_.follow(origin, direction, end);
  entry_ = smoky ? traversal_.entry() : 0.0;
  burning_.reset();
  slab_.reset();
  if (flames_ != nullptr) {
    burning_.emplace(*flames_, origin, direction, static_cast<float>(end));
  }
  if (smoky || burning_) {
    ends_.clear();
    for (const std::size_t tap : order_) {
      ends_.push_back(static_cast<float>(static_cast<double>(distances[tap]) - entry_));
    }
    const double g = light_.anisotropy,
                 base = 1.0 + g * g - 2.0 * g * dot(direction, light_.sun_direction);
    shading_.phase = static_cast<float>((1.0 - g * g) / (base * std::sqrt(base)));
    const Haze haze(light_, origin, direction);
    float t = burning_ ? static_cast<float>(-entry_) : 0.0F;
    while (next_ < taps_.count && state_.transmittance > 0.0F) {
      active_.count = 0;
      const float to = !smoky ? no_limit : t < 0.0F ? 0.0F : find_active_layers(t);
      smoky = smoky && to < no_limit;
      if (!smoky && !burning_) {
        break; // no smoke left
      }
      const float until = std::min(to, ends_[next_]);
      t = until > t ? pass(t, until, haze) : t;
      if (is_opaque()) {
        state_.end();
      }
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

void march(Layers layers, const FlameVolume* flames, const Rays& rays, const Taps& taps,
           const Illumination& light, const MarchSettings& settings, std::span<float> out) {
  check(rays, taps.distances, taps.count);
  if (layers.size() > ActiveLayers::most || taps.count < 1) {
    throw std::invalid_argument("march takes up to four layers, and at least one distance per ray");
  }
  for_rays(
      rays.size(), [&] { return Marcher(layers, flames, taps, light, settings); },
      [&](Marcher& marcher, std::size_t ray) {
        marcher.ray(rays.origin(ray), rays.direction(ray), ray,
                    out.data() + march_values(settings.parts) * taps.count * ray);
      });
}

} // namespace firetwin::volume
