#pragma once

#include "base/simd.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

/// Conversion of non-negative half floats without processor-specific instructions, so that all
/// processors give the same numbers.
namespace firetwin::volume {

/// Rounds to the nearest half float; values beyond the largest are clamped to it.
inline std::uint16_t to_half(float value) {
  constexpr float scale = 0x1p-112F, largest = 65504.0F;
  const auto bits = std::bit_cast<std::uint32_t>(std::min(value, largest) * scale);
  return static_cast<std::uint16_t>((bits + 0xFFFU + (bits >> 13 & 1U)) >> 13);
}

inline float from_half(std::uint16_t half) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(half) << 13) * 0x1p112F;
}

/// Converts eight half floats.
__attribute__((always_inline)) inline void from_halves(const std::uint16_t* halves, Lanes& out) {
  using Words = Simd<std::uint32_t, lane_count>;
  Simd<std::uint16_t, lane_count> packed;
  load(halves, packed);
  const Words words = __builtin_convertvector(packed, Words) << 13;
  load(&words, out);
  out *= 0x1p112F;
}

} // namespace firetwin::volume
