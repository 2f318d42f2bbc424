#pragma once

#include <span>

namespace firetwin::sensor {

/// The FIRETWIN paper's thermal view: the colours of the gradient added to the map's normalised
/// pixel intensities, clamp(rgb, 0, 1) + strength gradient, clamped to 0..1. NaN pixels count as 0.
///
/// Gradient: the palette "paper" from `low` to `high`; temperatures beyond are moved to the nearer
/// end, NaN is black.
/// @param rgb [3 n], 0..1 @param kelvin [n] @param colour [3 n] result
/// @throws std::invalid_argument unless low < high and strength are finite.
void thermal_composite(std::span<const float> rgb, std::span<const float> kelvin, double low,
                       double high, double strength, std::span<float> colour);

} // namespace firetwin::sensor
