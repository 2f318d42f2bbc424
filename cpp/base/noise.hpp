#pragma once

#include <cstdint>

/// What noises on a lattice are made of.
namespace firetwin {

/// MurmurHash3's finaliser: every input bit changes every output bit.
constexpr std::uint32_t murmur_finalizer(std::uint32_t h) {
  h = (h ^ (h >> 16U)) * 0x85EBCA6BU;
  h = (h ^ (h >> 13U)) * 0xC2B2AE35U;
  return h ^ (h >> 16U);
}

/// How much the value at a cell's other end counts at t, 0 to 1, of the way (Perlin 2002,
/// doi:10.1145/566654.566636): level at both ends, and so is its slope.
template <class T> constexpr T fade(T t) {
  return t * t * t * (t * (t * T{6} - T{15}) + T{10});
}

} // namespace firetwin
