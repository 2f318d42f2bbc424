#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace flame_solver {

/// A flame to solve. Lengths are in a unit near the flame length, times in sqrt(unit / g).
struct Settings {
  int cells = 32;                ///< per unit
  int nx = 64, ny = 48, nz = 48; ///< cells of the box
  int crown = 0;                 ///< 1: a crown in flames; 0: a line of fire along y
  int seed = 1;                  ///< of all noise
  int frames = 30;               ///< stored
  float spin = 4.0F;             ///< time before the first stored frame
  float interval = 0.08F;        ///< time between stored frames
  float wind = 0.0F;             ///< speed at half a unit
  float front = 1.15F;           ///< x of the leading edge of fuel, or of the trunk
  float depth = 0.35F;           ///< of burning fuel behind the front
  float inflow = 0.03F;          ///< mean speed of fuel gas, or its rate in a crown
  float uneven = 1.0F;           ///< strength of the patches of fuel
  float gusts = 0.25F;           ///< strength of gusts
  float eddies = 1.2F;           ///< strength of small eddies in hot gas
  float confinement = 0.3F;      ///< of vortices
  float longest_step = 0.02F;    ///< time
  float crown_base = 0.10F, crown_top = 0.62F, crown_radius = 0.22F;
  std::string out; ///< path of the frames; `.profiles` is added for the means
};

/// Seed of one of the noises of a flame.
inline std::uint32_t noise_seed(const Settings& settings, std::uint32_t number) {
  return static_cast<std::uint32_t>(settings.seed) * 64U + number;
}

/// Reads `key=value` arguments; unknown keys and values that are not numbers raise
/// invalid_argument.
Settings read_settings(const std::vector<std::string>& arguments);

} // namespace flame_solver
