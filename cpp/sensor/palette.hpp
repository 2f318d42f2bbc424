#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace firetwin::sensor {

using Colour = std::array<double, 3>; ///< red, green and blue of the display, 0..1

/// Colours at equal steps from cold to hot, linear between.
struct Palette {
  std::string_view name;
  std::span<const Colour> stops;

  /// Colour at 0..1; beyond, that of the nearer end.
  Colour at(double fraction) const;
};

/// "white-hot", "black-hot", "ironbow" (black, violet, red, orange, yellow and white, like that of
/// infrared cameras), "inferno" (matplotlib's by 17 stops, within 0.03) and "paper" (FIRETWIN's:
/// black, purple, red, orange, yellow and white).
/// @throws std::invalid_argument for a name that is none of them.
const Palette& palette(std::string_view name);

/// Names of the palettes.
std::vector<std::string> palettes();

/// Colours of temperatures: each is `palette` at (kelvin - low) / (high - low), and with a `knee`
/// above 0 (K) at log(1 + (kelvin - low) / knee) / log(1 + (high - low) / knee), which gives what
/// is within some knees of low more of the palette. Beyond the ends as at the nearer one, NaN as at
/// low.
/// @param kelvin [n] @param colour [3 n] result
/// @throws std::invalid_argument unless low < high are finite and knee is 0 or more.
void colour(std::span<const float> kelvin, double low, double high, double knee,
            const Palette& palette, std::span<float> colour);

} // namespace firetwin::sensor
