#include "flames/soot.hpp"

#include "base/smoothstep.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace firetwin::flames {
namespace {

constexpr float lean_end = 0.4F, lean_full = 0.75F;       // Z between which soot burns up
constexpr float peak = 1.25F, width = 1.2F;               // Z of the most soot, and its spread
constexpr float rich_soot = 0.4F;                         // share of soot far on the rich side
constexpr float young = 0.1F;                             // share of the soot at the foot
constexpr float grown = 0.13F;                            // height from which all has formed
constexpr float hottest = 1.1F;                           // Z
constexpr float lean_cooling = 1.2F, rich_cooling = 0.7F; // of the heat per Z
constexpr float burnout = 0.95F; // share of the lean soot that is gone over the tips
constexpr std::array<float, 2> tips{0.5F, 1.0F}; // heights between which it goes
constexpr float loss = 0.6F;                     // of the heat at the tips, by radiation
constexpr float loss_power = 1.3F;

} // namespace

float soot_at(float mixture, float height) {
  const float away = (mixture - peak) / width;
  const float burned = burnout * smoothstep(tips[0], tips[1], height) *
                       (1.0F - smoothstep(lean_full, hottest, mixture));
  const float formed = young + (1.0F - young) * smoothstep(0.0F, grown, height);
  return formed * (1.0F - burned) * smoothstep(lean_end, lean_full, mixture) *
         (rich_soot + (1.0F - rich_soot) * std::exp(-away * away));
}

float heat_at(float mixture, float height) {
  const float rich = std::max(mixture - hottest, 0.0F), lean = std::max(hottest - mixture, 0.0F);
  const float cooled = loss * std::pow(std::max(height, 0.0F), loss_power);
  return std::clamp(1.0F - rich_cooling * rich - lean_cooling * lean - cooled, 0.0F, 1.0F);
}

float luminance_at(float heat) {
  const float over = heat - core_heat;
  return std::pow(10.0F, std::min(dim_decades * over, bright_decades * over));
}

float heat_of(float luminance) {
  const float decades = std::log10(std::max(luminance, luminance_at(0.0F)));
  const float over = decades > 0.0F ? decades / bright_decades : decades / dim_decades;
  return std::clamp(core_heat + over, 0.0F, 1.0F);
}

} // namespace firetwin::flames
