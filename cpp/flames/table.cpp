#include "flames/table.hpp"

#include "base/smoothstep.hpp"
#include "flames/soot.hpp"

#include <algorithm>
#include <cmath>

namespace firetwin::flames {
namespace {

/// Z between which cooled soot is left over flames, and heights at which it begins (by eye).
constexpr std::array<float, 4> sooty{0.25F, 0.5F, 0.75F, 1.0F};
constexpr std::array<float, 2> soot_heights{0.45F, 1.0F};
constexpr float least_range = 1.0e-3F; // of codes: closer ones count as equal

} // namespace

FlameTable::FlameTable(std::span<const std::array<float, 3>> visible)
    : visible_(visible.begin(), visible.end()) {
  const auto last = static_cast<float>(codes - 1);
  for (std::size_t row = 0; row < heights; ++row) {
    const float height = tallest * static_cast<float>(row) / static_cast<float>(heights - 1);
    const float over = smoothstep(soot_heights[0], soot_heights[1], height);
    Lanes sum{}, before{};
    for (std::size_t n = 0; n < codes; ++n) {
      const float mixture = mixture_of(static_cast<float>(n) / last);
      const float soot = soot_at(mixture, height), heat = heat_at(mixture, height);
      const auto [red, green, blue] = radiance(heat);
      const float cool = over * smoothstep(sooty[0], sooty[1], mixture) *
                         (1.0F - smoothstep(sooty[2], sooty[3], mixture));
      const Lanes now{soot, soot * heat, soot * red, soot * green, soot * blue, cool, 0.0F, 0.0F};
      sum += n == 0 ? Lanes{} : (before + now) * (0.5F / last);
      before = now;
      store(sum, rows_[row].emplace_back().data());
    }
  }
}

std::array<float, 3> FlameTable::radiance(float heat) const {
  const auto last = static_cast<float>(visible_.size() - 1);
  const float at = std::clamp(heat * last, 0.0F, last - 1.0e-3F);
  const auto row = static_cast<std::size_t>(at);
  const float part = at - static_cast<float>(row);
  std::array<float, 3> out;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const float low = visible_[row][channel], high = visible_[row + 1][channel];
    out[channel] = low + (high - low) * part;
  }
  return out;
}

FlameOptics FlameTable::between(float first, float second, float height) const {
  const auto last = static_cast<float>(codes - 1);
  float low = std::clamp(std::min(first, second), 0.0F, 1.0F),
        high = std::clamp(std::max(first, second), 0.0F, 1.0F);
  if (high - low < least_range) {
    const float middle = std::clamp(0.5F * (low + high), least_range, 1.0F - least_range);
    low = middle - 0.5F * least_range;
    high = middle + 0.5F * least_range;
  }
  const float at = std::clamp(height / tallest, 0.0F, 0.9999F) * static_cast<float>(heights - 1);
  const auto row = static_cast<std::size_t>(at);
  const float up = at - static_cast<float>(row);
  const auto sum = [last](const Row& of, float code, Lanes& out) {
    const float place = std::min(code * last, last - 1.0e-3F);
    const auto n = static_cast<std::size_t>(place);
    Lanes next;
    load(of[n].data(), out);
    load(of[n + 1].data(), next);
    out += (next - out) * (place - static_cast<float>(n));
  };
  Lanes near[2], far[2];
  sum(rows_[row], low, near[0]);
  sum(rows_[row], high, near[1]);
  sum(rows_[row + 1], low, far[0]);
  sum(rows_[row + 1], high, far[1]);
  const Lanes under = near[1] - near[0], over = far[1] - far[0];
  const Lanes mean = (under + (over - under) * up) * (1.0F / (high - low));
  return {mean[0], mean[1], {mean[2], mean[3], mean[4]}, mean[5]};
}

} // namespace firetwin::flames
