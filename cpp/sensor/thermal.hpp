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

/// Hot spots over a picture: below + part (above - below), where `part` of a pixel is `opacity`,
/// times (kelvin - start) / (full - start) held to 0..1. NaN temperatures show what is below.
/// @param below, above [3 n] @param kelvin [n] @param colour [3 n] result
/// @throws std::invalid_argument unless start < full are finite and opacity is from 0 to 1.
void overlay(std::span<const float> below, std::span<const float> above,
             std::span<const float> kelvin, double start, double full, double opacity,
             std::span<float> colour);

} // namespace firetwin::sensor
