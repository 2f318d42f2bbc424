#pragma once

#include <span>

namespace firetwin::sensor {

/// Thermal view of the FIRETWIN paper: clamp(rgb, 0, 1) + strength * gradient, clamped to 0..1. NaN
/// pixels are 0.
///
/// The gradient is the palette "paper" from `low` to `high`; temperatures are clamped, NaN is
/// black.
/// @param rgb [3 n], 0..1 @param kelvin [n] @param colour [3 n] result
/// @throws std::invalid_argument unless low < high and strength are finite.
void thermal_composite(std::span<const float> rgb, std::span<const float> kelvin, double low,
                       double high, double strength, std::span<float> colour);

/// Blends hot spots over an image: below + a (above - below) with a = opacity * clamp((kelvin -
/// start) / (full - start), 0, 1). NaN temperatures show `below`.
/// @param below, above [3 n] @param kelvin [n] @param colour [3 n] result
/// @throws std::invalid_argument unless start < full are finite and opacity is from 0 to 1.
void overlay(std::span<const float> below, std::span<const float> above,
             std::span<const float> kelvin, double start, double full, double opacity,
             std::span<float> colour);

} // namespace firetwin::sensor
