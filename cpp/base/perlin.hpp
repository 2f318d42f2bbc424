#pragma once

#include "base/noise.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace firetwin {

/// Factors that hash the points of a 3-D lattice.
namespace lattice_primes {
inline constexpr std::uint32_t prime_x = 0x9E3779B1U, prime_y = 0x85EBCA77U, prime_z = 0xC2B2AE3DU,
                               of_seed = 0x27D4EB2FU;
}

/// 3-D gradient noise of wavelength 1, about -1 to 1 with mean 0 (Perlin 2002).
inline float perlin_at(float x, float y, float z, std::uint32_t seed) {
  using namespace lattice_primes;
  const float x0 = std::floor(x), y0 = std::floor(y), z0 = std::floor(z);
  const float a = x - x0, b = y - y0, c = z - z0;
  const auto lattice = [](float at, std::uint32_t along) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(at)) * along;
  };
  const std::array<std::uint32_t, 2> i{lattice(x0, prime_x), lattice(x0, prime_x) + prime_x},
      j{lattice(y0, prime_y), lattice(y0, prime_y) + prime_y},
      k{lattice(z0, prime_z) ^ seed * of_seed, (lattice(z0, prime_z) + prime_z) ^ seed * of_seed};
  const std::array<float, 2> u{a, a - 1.0F}, v{b, b - 1.0F}, w{c, c - 1.0F};
  const auto rise = [&](std::size_t up, std::size_t north, std::size_t east) {
    return cube_rise(murmur_finalizer(i[east] ^ j[north] ^ k[up]), u[east], v[north], w[up]);
  };
  return gradient_noise(rise, c, b, a);
}

} // namespace firetwin
