#pragma once

#include <span>

namespace firetwin::sensor {

/// Thermal gradient: black, purple, red, orange, yellow, white at equal steps from `low` to `high`,
/// linear between; temperatures beyond are moved to the nearer end, NaN is black.
/// @param kelvin [n] @param colour [3 n], 0..1
/// @throws std::invalid_argument unless low < high are finite.
void thermal_gradient(std::span<const float> kelvin, double low, double high,
                      std::span<float> colour);

/// The FIRETWIN paper's thermal view: the colours of the gradient added to the map's normalised
/// pixel intensities, clamp(rgb, 0, 1) + strength gradient, clamped to 0..1. NaN pixels count as 0.
/// @param rgb [3 n], 0..1 @param colour [3 n] result
void thermal_composite(std::span<const float> rgb, std::span<const float> kelvin, double low,
                       double high, double strength, std::span<float> colour);

} // namespace firetwin::sensor
