#pragma once

#include <cstdint>

namespace firetwin::flames {

/// Soot and heat of burning gas by its mixture fraction Z over the stoichiometric one.
///
/// Soot forms on the rich side of the flame sheet and burns up on the lean side, where cool soot is
/// left at the tips. It needs time to form, so the foot of a flame is thin. Gas is hottest near Z =
/// 1 (fast chemistry) and cools with height as soot radiates. Widths and slopes are by eye; they
/// set colours, not power (see `FlameLight`).

constexpr float core_heat = 0.75F; ///< heat at which the luminance is 1
/// Decades of luminance in a unit of heat, below and above the core: hotter parts of a flame are
/// all but white in a picture, and would have no structure.
constexpr float dim_decades = 3.4F, bright_decades = 2.2F;

/// Largest mixture fraction that is stored, over the stoichiometric one.
constexpr float richest = 4.0F;

/// Returns Z of a stored code, 0 to 1: its square root is stored, which is finer on the lean side.
inline float mixture_of(float code) {
  return richest * code * code;
}

/// Returns the extinction by soot at a Z and a height in flame lengths, relative to a flame's
/// greatest.
float soot_at(float mixture, float height);

/// Returns the heat, 0 to 1, at a Z and a height in flame lengths.
float heat_at(float mixture, float height);

/// Returns the luminance at a heat, relative to that at `core_heat`.
float luminance_at(float heat);

/// Returns the heat at which the luminance is `luminance`; 0 for the darkest.
float heat_of(float luminance);

} // namespace firetwin::flames
