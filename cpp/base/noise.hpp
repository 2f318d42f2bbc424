#pragma once

#include "base/interpolation.hpp"

#include <array>
#include <bit>
#include <cstdint>

/// Gradient noise on a lattice, and hashes of its points.
namespace firetwin {

/// MurmurHash3's finaliser: every input bit changes every output bit.
constexpr std::uint32_t murmur_finalizer(std::uint32_t h) {
  h = (h ^ (h >> 16U)) * 0x85EBCA6BU;
  h = (h ^ (h >> 13U)) * 0xC2B2AE35U;
  return h ^ (h >> 16U);
}

/// Hash of a point of a 2-D lattice.
constexpr std::uint32_t lattice_hash(std::int64_t x, std::int64_t y, std::int64_t seed) {
  const std::uint32_t h =
      static_cast<std::uint32_t>(x) * 0x9E3779B1U ^ static_cast<std::uint32_t>(y) * 0x85EBCA77U;
  return murmur_finalizer(h ^ (static_cast<std::uint32_t>(seed) * 0x27D4EB2FU + 0x165667B1U));
}

/// Jenkins's hash of three numbers (lookup3, 2006), as in the noise of renderers.
constexpr std::uint32_t jenkins_hash(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  constexpr std::uint32_t start = 0xDEADBEEFU + (3U << 2U) + 13U;
  std::uint32_t a = start + x, b = start + y, c = start + z;
  c = (c ^ b) - std::rotl(b, 14);
  a = (a ^ c) - std::rotl(c, 11);
  b = (b ^ a) - std::rotl(a, 25);
  c = (c ^ b) - std::rotl(b, 16);
  a = (a ^ c) - std::rotl(c, 4);
  b = (b ^ a) - std::rotl(a, 14);
  return (c ^ b) - std::rotl(b, 24);
}

/// Quintic fade curve of Perlin noise on 0..1 (Perlin 2002, doi:10.1145/566654.566636); first and
/// second derivatives are 0 at both ends.
template <class T> constexpr T fade(T t) {
  return t * t * t * (t * (t * T{6} - T{15}) + T{10});
}

/// 2-D gradient noise of wavelength 1 (Perlin 2002).
/// @param rise(j, i) value at the point of the gradient at corner (j, i)
/// @param y, x position in the cell, 0 to 1
template <class Rise, class T> constexpr T gradient_noise(const Rise& rise, T y, T x) {
  return bilinear(rise, fade(y), fade(x));
}

/// 3-D gradient noise: rise(k, j, i).
template <class Rise, class T> constexpr T gradient_noise(const Rise& rise, T z, T y, T x) {
  return trilinear(rise, fade(z), fade(y), fade(x));
}

/// Value at an offset of one of the twelve gradients towards the edges of a cube (Perlin 2002),
/// chosen by the lowest four bits of a hash.
template <class T> constexpr T cube_rise(std::uint32_t h, T x, T y, T z) {
  const std::uint32_t which = h & 15U;
  const T u = which < 8 ? x : y;
  const T w = (which & 13U) == 12 ? x : z;
  const T v = which < 4 ? y : w;
  return ((which & 1U) != 0 ? -u : u) + ((which & 2U) != 0 ? -v : v);
}

} // namespace firetwin
