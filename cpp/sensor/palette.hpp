#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace firetwin::sensor {

using Colour = std::array<double, 3>; ///< display RGB, 0..1

/// Colours at equal steps from cold to hot, interpolated linearly.
struct Palette {
  std::string_view name;
  std::span<const Colour> stops;

  /// Colour at a fraction, clamped to 0..1.
  Colour at(double fraction) const;
};

/// "white-hot", "black-hot", "ironbow" (black, violet, red, orange, yellow and white, as in
/// infrared cameras), "inferno" (matplotlib's, by 17 stops, within 0.03) and "paper" (FIRETWIN
/// paper: black, purple, red, orange, yellow and white).
/// @throws std::invalid_argument for an unknown name
const Palette& palette(std::string_view name);

/// Names of the palettes.
std::vector<std::string> palettes();

/// Maps temperatures to colours: `palette` at (kelvin - low) / (high - low), or with a `knee` above
/// 0 (K) at log(1 + (kelvin - low) / knee) / log(1 + (high - low) / knee), which expands
/// temperatures near low. Temperatures are clamped to low..high; NaN is low.
/// @param kelvin [n] @param colour [3 n] result
/// @throws std::invalid_argument unless low < high are finite and knee is 0 or more
void colour(std::span<const float> kelvin, double low, double high, double knee,
            const Palette& palette, std::span<float> colour);

} // namespace firetwin::sensor
