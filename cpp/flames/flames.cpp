#include "flames/flames.hpp"

#include "base/smoothstep.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firetwin::flames {
namespace {

constexpr float least_step = 0.015F; // m
constexpr float fine_step =
    0.018F; // of the flame length; 0.024 shows ribs where it varies (by eye)
constexpr float step_pixels = 0.7F;
constexpr float most_step = 0.2F;                   // of the flame length
constexpr std::array<float, 2> at_lens{0.4F, 2.0F}; // m, distances up to which flames are left out
constexpr std::array<float, 2> deepest{10.0F,
                                       4.0F}; // m, and cells, below the map's ground where rays end
constexpr float thin_flame = 1.0e-4F;         // 1/m, extinction that is left out
constexpr float thin_gas = 1.0e-3F;           // code that is left out
constexpr float typical_path = 0.06F; // way through the sootiest gas of a flame, in its lengths
constexpr float whole = 0.999F;       // share from which flames are not thinned out

/// Returns the extinction, 1/m, of flames that fill a share of their drawn length: it lets as much
/// light through as the rest of the pixel does.
float thinned(float extinction, float length, float drawn, float share) {
  const float covered = share * length / drawn;
  const float through = std::exp(-extinction * length * typical_path);
  return -std::log(1.0F - covered * (1.0F - through)) / (typical_path * drawn);
}

} // namespace

FlameVolume::FlameVolume(const FlamePatches& patches, std::span<const Spindle> crowns,
                         std::shared_ptr<const FlameLibrary> library, const FlameShape& shape,
                         const FlameLight& light, const FlameView& view, const Vector& origin,
                         double time)
    : library_(std::move(library)), origin_(origin), light_(light), view_(view),
      table_(light.visible), crowns_(crowns, shape, library_->crowns().front()->top(),
                                     0.5F * library_->crowns().front()->across(), origin),
      tiles_(patches,
             {{FlameField::lean * shape.wind[0], FlameField::lean * shape.wind[1]},
              shape.launch,
              shape.acceleration},
             {library_->ahead(), library_->behind(), library_->top(),
              FlameField::wide_pixels * view.pixel},
             crowns_, origin),
      field_(tiles_, crowns_, *library_, shape, origin, time) {
  if (light_.extinction.empty()) {
    throw std::invalid_argument("extinction needs a row");
  }
}

/// Returns the visible and the infrared extinction, 1/m.
std::array<float, 2> FlameVolume::extinction(float length, float drawn, float share) const {
  const auto& rows = light_.extinction;
  std::size_t n = 0;
  while (n < rows.size() && rows[n][0] < length) {
    ++n;
  }
  const auto& low = rows[n == 0 ? 0 : n - 1];
  const auto& high = rows[std::min(n, rows.size() - 1)];
  const float part = high[0] > low[0] ? (length - low[0]) / (high[0] - low[0]) : 0.0F;
  std::array<float, 2> out{low[1] + part * (high[1] - low[1]), low[2] + part * (high[2] - low[2])};
  if (share * length < whole * drawn) {
    for (float& each : out) {
      each = thinned(each, length, drawn, share);
    }
  }
  return out;
}

FlameStep FlameVolume::step(const FlameSamples::Codes& before, const FlameSamples& samples,
                            std::size_t lane) const {
  FlameStep out;
  std::array<float, 3> light{};
  float hot = 0.0F;
  for (std::size_t kind = 0; kind < FlameSamples::kinds; ++kind) {
    const GasLanes& of = samples.gas[kind];
    if (!of.any || of.length[lane] <= 0.0F) {
      continue;
    }
    const float fine = of.fine[lane], code = of.code[lane], old = before[kind];
    const float coarse = of.coarse.extinction[lane];
    if (std::max(code, old) * fine < thin_gas && coarse < thin_gas) {
      continue;
    }
    const auto [visible, infrared] = extinction(of.length[lane], of.drawn[lane], of.share[lane]);
    FlameOptics optics{};
    if (fine > 0.0F) {
      optics = table_.between(old, code, of.height[lane]);
    }
    float flame = fine * optics.extinction, warm = fine * optics.hot;
    std::array<float, 3> glow{fine * optics.light[0], fine * optics.light[1],
                              fine * optics.light[2]};
    if (coarse > 0.0F) {
      const float part = of.coarse.hot[lane];
      const auto colour = table_.radiance(part / coarse);
      flame += coarse;
      warm += part;
      for (std::size_t channel = 0; channel < 3; ++channel) {
        glow[channel] += coarse * colour[channel];
      }
    }
    const float soot = fine * light_.soot * optics.soot;
    out.extinction += visible * (flame + soot);
    out.flames += visible * flame;
    out.infrared += infrared * flame;
    hot += infrared * warm;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      light[channel] += visible * (glow[channel] + (flame + soot) * light_.soot_light[channel]);
    }
  }
  if (out.extinction > 0.0F) {
    out.heat = out.infrared > 0.0F ? hot / out.infrared : 0.0F;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      out.radiance[channel] = light[channel] / out.extinction;
    }
  }
  return out;
}

float FlameView::share(float away) const {
  const float lens = std::clamp((away - at_lens[0]) / (at_lens[1] - at_lens[0]), 0.0F, 1.0F);
  return lens * (1.0F - smoothstep(fade[0], fade[1], away));
}

float BandRadiance::at(float kelvin) const {
  const double last = static_cast<double>(radiance.size() - 1);
  const double place = std::clamp((static_cast<double>(kelvin) - coldest) / step, 0.0, last);
  const auto low = std::min(static_cast<std::size_t>(place), radiance.size() - 2);
  const auto part = static_cast<float>(place - static_cast<double>(low));
  return radiance[low] + part * (radiance[low + 1] - radiance[low]);
}

FlameRay::FlameRay(const FlameVolume& flames, const Vector& origin, const Vector& direction,
                   float end, const BandRadiance* band)
    : flames_(flames), band_(band), at_(0.0F), end_(end) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    start_[axis] = static_cast<float>(origin[axis] - flames.origin()[axis]);
    direction_[axis] = static_cast<float>(direction[axis]);
  }
  const FlameTiles& tiles = flames.tiles();
  end_ = tiles.empty() ? -1.0F : std::min(end_, flames.view().fade[1]);
  const auto clip = [&](float low, float high, std::size_t axis) {
    if (std::abs(direction_[axis]) < 1.0e-9F) {
      end_ = start_[axis] < low || start_[axis] > high ? -1.0F : end_;
      return;
    }
    const float a = (low - start_[axis]) / direction_[axis],
                b = (high - start_[axis]) / direction_[axis];
    at_ = std::max(at_, std::min(a, b) + (std::min(a, b) > 0.0F ? 1.0e-3F : 0.0F));
    end_ = std::min(end_, std::max(a, b));
  };
  if (end_ > 0.0F) {
    clip(tiles.bounds()[0], tiles.bounds()[1], 0);
    clip(tiles.bounds()[2], tiles.bounds()[3], 1);
    clip(tiles.heights()[0] - 1000.0F, tiles.heights()[1], 2);
  }
}

bool FlameRay::next(float begin, float end, FlameSlab& slab) {
  constexpr float past = 1.0e-3F; // m
  end = std::min(end, end_);
  begin = std::min(begin, end);
  while (at_ < begin) {
    const float x = start_[0] + direction_[0] * at_, y = start_[1] + direction_[1] * at_,
                z = start_[2] + direction_[2] * at_;
    FlameTiles::Tile tile;
    if (!flames_.tiles().find(x, y, tile)) {
      at_ = end_; // the largest square contains all others
      return false;
    }
    float leave = end;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const float speed = direction_[axis], here = axis == 0 ? x : y;
      if (std::abs(speed) > 1.0e-9F) {
        const float face = tile.bounds[2 * axis + (speed > 0.0F ? 1 : 0)];
        leave = std::min(leave, at_ + std::max((face - here) / speed, 0.0F) + past);
      }
    }
    if (z > tile.top) {
      const bool enters = tile.top > FlameTiles::none && direction_[2] < -1.0e-6F;
      at_ = enters ? std::min(leave, at_ + (tile.top - z) / direction_[2] + past) : leave;
      continue;
    }
    const float above = z - flames_.tiles().ground_at(x, y);
    const float cell = (tile.bounds[1] - tile.bounds[0]) / static_cast<float>(FlameTiles::side);
    if (above < -(deepest[0] + deepest[1] * cell)) {
      at_ = end_;
      return false;
    }
    const float height = std::clamp(above, 0.0F, 1.0e6F);
    const float free = flames_.field().free_distance({x, y, z}, height, direction_);
    if (free > 0.0F) {
      at_ = std::min(at_ + std::max(free, past), leave);
      continue;
    }
    fill(at_, step_at(tile, height, end), slab);
    at_ = slab.to;
    if (slab.transmittance < 1.0F || slab.infrared_transmittance < 1.0F) {
      return true;
    }
  }
  return false;
}

/// Returns the length of a step: shorter for low flames, and where wind shears them.
float FlameRay::step_at(const FlameTiles::Tile& tile, float height, float limit) const {
  const float pixel = step_pixels * flames_.view().pixel * at_;
  const float length = before_at_ == at_ ? std::min(tile.length, lowest_) : tile.length;
  const float shear = std::max(flames_.field().foot_speed(height, direction_), 1.0F);
  const float size = std::max(fine_step * length / shear, least_step);
  const float step = std::clamp(pixel, size, std::max(most_step * length, size));
  return std::min(step, (limit - at_) / static_cast<float>(lane_count) + 1.0e-6F);
}

/// Samples are at the ends of the steps; each step is between two of them.
void FlameRay::fill(float from, float step, FlameSlab& slab) {
  const FlameLight& light = flames_.light();
  const FlameView& view = flames_.view();
  slab = {from, from + step * static_cast<float>(lane_count), {}, 1.0F, 0.0F, 1.0F, 0.0F, {}};
  Lanes away;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    away[lane] = from + step * (static_cast<float>(lane) + 1.0F);
  }
  FlameSamples samples;
  flames_.field().evaluate(start_[0] + direction_[0] * away, start_[1] + direction_[1] * away,
                           start_[2] + direction_[2] * away, view.pixel * away[lane_count / 2],
                           samples);
  if (before_at_ != from) {
    before_ = samples.codes(0);
  }
  before_at_ = slab.to;
  lowest_ = samples.lowest();
  if (samples.any()) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const FlameStep found =
          flames_.step(lane > 0 ? samples.codes(lane - 1) : before_, samples, lane);
      const float part = view.share(away[lane] - 0.5F * step);
      slab.red[lane] = slab.radiance[0];
      if (found.extinction * part <= thin_flame) {
        continue;
      }
      slab.share += found.flames * part > thin_flame ? 1.0F / static_cast<float>(lane_count) : 0.0F;
      const float kept = std::exp(-found.extinction * part * step);
      const float share = slab.transmittance * (1.0F - kept);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        slab.radiance[channel] += share * found.radiance[channel];
      }
      slab.transmittance *= kept;
      slab.red[lane] = slab.radiance[0];
      if (band_ != nullptr) {
        const float passed = std::exp(-found.infrared * part * step);
        const double kelvin =
            light.coolest + (light.hottest - light.coolest) * static_cast<double>(found.heat);
        slab.infrared +=
            slab.infrared_transmittance * (1.0F - passed) * band_->at(static_cast<float>(kelvin));
        slab.infrared_transmittance *= passed;
      }
    }
  }
  before_ = samples.codes(lane_count - 1);
  if (slab.infrared > 0.0F) {
    const float far = 0.001F * away[lane_count / 2];
    slab.infrared *= std::exp(-light.dim * std::sqrt(far * std::sqrt(far)));
  }
}

} // namespace firetwin::flames
