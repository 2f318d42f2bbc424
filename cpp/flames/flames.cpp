#include "flames/flames.hpp"

#include "base/smoothstep.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firetwin::flames {
namespace {

constexpr float least_step = 0.02F, most_step = 0.5F; // m
constexpr float fine_step = 0.016F;                   // of the flame length
constexpr float near_step = 0.013F;                   // of the distance from the eye
constexpr float step_pixels = 0.8F;
constexpr float finest_eddy = 1.2F;                 // of the step: smaller ones would be noise
constexpr float finest_pixels = 1.7F;               // pixels: eddies are folded, so they are finer
constexpr std::array<float, 2> at_lens{0.4F, 2.0F}; // m, distances up to which flames are left out
constexpr float thin_flame = 1.0e-4F;               // 1/m, extinction that is left out

} // namespace

FlameVolume::FlameVolume(std::span<const FlameSquare> squares, std::span<const Spindle> spindles,
                         const FlameShape& shape, const FlameLight& light, const FlameView& view,
                         const Vector& origin, double time)
    : origin_(origin), light_(light), view_(view),
      tiles_(squares, spindles, shape.wind, shape.launch, shape.acceleration, origin),
      field_(tiles_, shape, origin, time) {
  if (light_.visible.size() < 2 || light_.scales.empty()) {
    throw std::invalid_argument("visible must have at least two rows, and scales one");
  }
}

std::array<float, 2> FlameVolume::scale(float length) const {
  const auto& rows = light_.scales;
  std::size_t n = 0;
  while (n < rows.size() && rows[n][0] < length) {
    ++n;
  }
  if (n == 0 || n == rows.size()) {
    const auto& row = n == 0 ? rows.front() : rows.back();
    return {row[1], row[2]};
  }
  const auto &low = rows[n - 1], &high = rows[n];
  const float part = (length - low[0]) / (high[0] - low[0]);
  return {low[1] + part * (high[1] - low[1]), low[2] + part * (high[2] - low[2])};
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

bool FlameRay::next(float limit, FlameSlab& slab) {
  constexpr float past = 1.0e-3F; // m
  const FlameView& view = flames_.view();
  limit = std::min(limit, end_);
  while (at_ < limit) {
    const float x = start_[0] + direction_[0] * at_, y = start_[1] + direction_[1] * at_,
                z = start_[2] + direction_[2] * at_;
    FlameTiles::Tile tile;
    if (!flames_.tiles().find(x, y, tile)) {
      at_ = end_; // the largest square contains all others
      return false;
    }
    float leave = limit;
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
    const float free = flames_.field().free_distance({x, y, z}, direction_);
    if (free > 0.0F) {
      at_ = std::min(at_ + std::max(free, past), leave);
      continue;
    }
    const float size =
        std::clamp(std::min(fine_step * tile.length, near_step * at_), least_step, most_step);
    float step = std::max(size, step_pixels * view.pixel * at_);
    const auto count = static_cast<float>(lane_count);
    step = std::min(step, (limit - at_) / count + 1.0e-6F);
    fill(at_, step, slab);
    at_ += step * count;
    if (slab.transmittance < 1.0F || slab.infrared_transmittance < 1.0F) {
      return true;
    }
  }
  return false;
}

void FlameRay::fill(float from, float step, FlameSlab& slab) const {
  const FlameLight& light = flames_.light();
  const FlameView& view = flames_.view();
  slab = {from, from + step * static_cast<float>(lane_count), {}, 1.0F, 0.0F, 1.0F, 0.0F};
  Lanes away;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    away[lane] = from + step * (static_cast<float>(lane) + 0.5F);
  }
  FlameSamples found;
  const float fine =
      std::max(finest_pixels * view.pixel * away[lane_count / 2], finest_eddy * step);
  flames_.field().evaluate(start_[0] + direction_[0] * away, start_[1] + direction_[1] * away,
                           start_[2] + direction_[2] * away, fine, found);
  const auto last = static_cast<float>(light.visible.size() - 1);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const float part = view.share(away[lane]);
    const auto [visible, emissive] = flames_.scale(found.length[lane]);
    const float burning = light.extinction * visible * found.flame[lane] * part;
    const float soot = light.soot * found.soot[lane] * part, all = burning + soot;
    if (all <= thin_flame) {
      continue;
    }
    slab.share += burning > thin_flame ? 1.0F / static_cast<float>(lane_count) : 0.0F;
    const float kept = std::exp(-all * step);
    const float share = slab.transmittance * (1.0F - kept) / all;
    const float at = std::min(found.heat[lane] * last, last - 1.0e-3F);
    const auto row = static_cast<std::size_t>(at);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const float low = light.visible[row][channel], high = light.visible[row + 1][channel];
      slab.radiance[channel] +=
          share * (burning * (low + (high - low) * (at - static_cast<float>(row))) +
                   soot * light.soot_light[channel]);
    }
    slab.transmittance *= kept;
    if (band_ != nullptr) {
      const float passed = std::exp(-light.infrared * emissive * found.flame[lane] * part * step);
      const double kelvin =
          light.coolest + (light.hottest - light.coolest) * static_cast<double>(found.heat[lane]);
      slab.infrared +=
          slab.infrared_transmittance * (1.0F - passed) * band_->at(static_cast<float>(kelvin));
      slab.infrared_transmittance *= passed;
    }
  }
  if (slab.infrared > 0.0F) {
    const float far = 0.001F * away[lane_count / 2];
    slab.infrared *= std::exp(-light.dim * std::sqrt(far * std::sqrt(far)));
  }
}

} // namespace firetwin::flames
