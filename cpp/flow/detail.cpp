#include "flow/detail.hpp"

#include "base/interpolation.hpp"
#include "base/smoothstep.hpp"
#include "flow/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firetwin::flow {
namespace {

constexpr float vigorous_rise[] = {0.4F, 2.5F};    // m/s
constexpr float vigorous_warmth[] = {0.12F, 0.9F}; // K
constexpr float vigorous_age = 420.0F;             // s
constexpr float crisp_reach[] = {0.8F, 7.0F};      // amplitude of crisp noise
constexpr float whole[] = {
    5.5F, 8.5F}; // local maximum of the amount at which noise has its least and its full amplitude
constexpr float billow_slope = 1.4F;
constexpr float cloud_depth = 500.0F; // m above the condensation height over which vapour condenses
constexpr float cloud_ages[] = {600.0F, 1600.0F}; // s, ages between which droplets evaporate

float ramp(float low, float high, float x) {
  return std::clamp((x - low) / (high - low), 0.0F, 1.0F);
}

void check(const SmokeSnapshot& m) {
  const std::size_t n = m.shape.size();
  const auto plane = static_cast<std::size_t>(m.shape.ny * m.shape.nx);
  const bool fits = m.levels.size() == static_cast<std::size_t>(m.shape.nz) &&
                    m.heights.size() == n && m.ground.size() == plane && m.smoke.size() == n &&
                    m.age.size() == n && m.rise.size() == n && m.temperature_excess.size() == n &&
                    (m.glow.empty() || m.glow.size() == n) && m.drift.size() == Drift::parts * n;
  if (!fits || n == 0 || m.shape.nz < 2) {
    throw std::invalid_argument(
        "the arrays of the snapshot must have the same shape, with at least two levels");
  }
}

} // namespace

Detail::Detail(const SmokeSnapshot& m, const DetailSettings& settings)
    : shape_(m.shape), spacing_(m.spacing), corner_(m.corner),
      levels_(m.levels.begin(), m.levels.end()), weights_(m.weights), settings_(settings),
      unit_(unit / settings.scale) {
  check(m);
  for (std::size_t p = 0; p < Drift::phases; ++p) {
    seeds_[p] = (settings.seed * 2U + static_cast<std::uint32_t>(p)) * 977U +
                static_cast<std::uint32_t>(m.turns[p]);
  }
  for (const float level : levels_) {
    terrain_share_.push_back(std::exp(-level / (settings.scale * terrain_fade)));
  }
  Values amount(shape_.size());
  each(shape_.nz, [&](Index k) {
    const auto plane = static_cast<std::size_t>(shape_.ny * shape_.nx);
    for (std::size_t n = static_cast<std::size_t>(k) * plane, end = n + plane; n < end; ++n) {
      amount[n] = std::log(std::max(m.smoke[n] / unit_, 1.0F));
    }
  });
  amount_ = Columns(amount.data(), shape_);
  ground_ = Columns(m.ground.data(), {1, shape_.ny, shape_.nx});
  heights_ = Columns(m.heights.data(), shape_);
  age_ = Columns(m.age.data(), shape_);
  glow_ = m.glow.empty() ? Columns() : Columns(m.glow.data(), shape_);
  find_vigour(m, amount);
  find_reach(m, amount);
  find_drift(m);
}

void Detail::find_drift(const SmokeSnapshot& m) {
  Values part(shape_.size());
  for (std::size_t p = 0; p < Drift::parts; ++p) {
    if (!shows(p / 3)) {
      continue;
    }
    for (std::size_t n = 0; n < part.size(); ++n) {
      part[n] = m.drift[n * Drift::parts + p];
    }
    blur(part, shape_, settings_.blur);
    drift_[p] = Columns(part.data(), shape_);
  }
}

/// Returns the condensed share of vapour that rose to a height, 0 to 1.
float Detail::condensed_share(float height) const {
  return smoothstep(settings_.condensation_height, settings_.condensation_height + cloud_depth,
                    height);
}

void Detail::find_vigour(const SmokeSnapshot& m, const Values& amount) {
  Values near = amount, dense = amount;
  dilate(near, shape_, 2);
  blur(dense, shape_, {0.7, 0.7, 0.7});
  dilate(dense, shape_, 2);
  Values vigour(shape_.size());
  const float speed = std::cbrt(settings_.scale), time = speed * speed;
  for (std::size_t n = 0; n < vigour.size(); ++n) {
    const float cap = condensed_share(m.heights[n]);
    const float vigorous = ramp(vigorous_rise[0], vigorous_rise[1], m.rise[n] / speed) +
                           ramp(vigorous_warmth[0], vigorous_warmth[1], m.temperature_excess[n]) +
                           0.8F * ramp(vigorous_age, 0.0F, m.age[n] / time) +
                           cap * ramp(cloud_ages[1], cloud_ages[0], m.age[n]);
    const float droplets = cloud_amount * cap;
    vigour[n] = std::max(std::min(vigorous, 1.0F) * ramp(5.0F, 6.8F, near[n] + droplets),
                         ramp(6.0F, 7.6F, dense[n]));
  }
  blur(vigour, shape_, {1.0, 1.0, 1.0});
  for (float& value : vigour) {
    value = smoothstep(0.1F, 0.7F,
                       value); // few cells remain in between: half billows, half veils look blurred
  }
  vigour_ = Columns(vigour.data(), shape_);
}

void Detail::find_reach(const SmokeSnapshot& m, const Values& amount) {
  const Shape& s = shape_;
  Values reach(s.size()), square(s.size());
  each(s.nz, [&](Index k) {
    const Index below = std::max(k - 1, Index{0}), above = std::min(k + 1, s.nz - 1);
    const float gap = std::max(
        levels_[static_cast<std::size_t>(above)] - levels_[static_cast<std::size_t>(below)], 1.0F);
    for (Index j = 0; j < s.ny; ++j) {
      const Index front = std::max(j - 1, Index{0}), back = std::min(j + 1, s.ny - 1);
      for (Index i = 0; i < s.nx; ++i) {
        const auto value = [&](Index kk, Index jj, Index ii) {
          return amount[static_cast<std::size_t>((kk * s.ny + jj) * s.nx + ii)];
        };
        const Index left = std::max(i - 1, Index{0}), right = std::min(i + 1, s.nx - 1);
        const auto cells = [&](Index a, Index b) {
          return static_cast<float>(std::max(b - a, Index{1})) * static_cast<float>(spacing_);
        };
        const float dx = (value(k, j, right) - value(k, j, left)) / cells(left, right);
        const float dy = (value(k, back, i) - value(k, front, i)) / cells(front, back);
        const float dz = (value(above, j, i) - value(below, j, i)) / gap;
        const auto n = static_cast<std::size_t>((k * s.ny + j) * s.nx + i);
        const float slope = amount[n] > 0.5F ? std::sqrt(dx * dx + dy * dy + dz * dz) : 0.0F;
        reach[n] = slope;
        square[n] = slope * slope;
      }
    }
  });
  blur(square, shape_, {2.0, 2.0, 2.0});
  blur(reach, shape_, {2.0, 2.0, 2.0});
  Values densest = amount;
  dilate(densest, shape_, 2);
  blur(densest, shape_, {1.0, 1.0, 1.0});
  Values solid(s.size());
  for (std::size_t n = 0; n < reach.size(); ++n) {
    const float steep = square[n] / std::max(reach[n], 1.0e-6F);
    const float thick = densest[n] + cloud_amount * condensed_share(m.heights[n]);
    const float most = lerp(crisp_reach[0], crisp_reach[1], ramp(whole[0], whole[1], thick));
    solid[n] = ramp(core[0], core[1], thick);
    reach[n] =
        std::clamp(billow_slope * static_cast<float>(settings_.size) * steep, crisp_reach[0], most);
  }
  reach_ = Columns(reach.data(), shape_);
  solid_ = Columns(solid.data(), shape_);
}

} // namespace firetwin::flow
