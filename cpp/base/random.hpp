#pragma once

#include <array>
#include <cstdint>

/// Counter-based random numbers: each depends only on its key and counter, so any thread can draw
/// any of them.
namespace firetwin {

/// 128-bit unsigned integer.
struct Uint128 {
  std::uint64_t high, low;
};

constexpr Uint128 product(std::uint64_t a, std::uint64_t b) {
#ifdef __SIZEOF_INT128__
  __extension__ using Number = unsigned __int128;
  const Number whole = Number{a} * b;
  return {static_cast<std::uint64_t>(whole >> 64), static_cast<std::uint64_t>(whole)};
#else // in 32-bit halves: Visual C++
  constexpr std::uint64_t half = 0xFFFFFFFF;
  const std::uint64_t low = (a & half) * (b & half);
  const std::uint64_t left = (a >> 32) * (b & half) + (low >> 32);
  const std::uint64_t right = (a & half) * (b >> 32) + (left & half);
  return {(a >> 32) * (b >> 32) + (left >> 32) + (right >> 32), (right << 32) | (low & half)};
#endif
}

/// Philox4x64-10: a counter-based random number generator (Salmon et al. 2011, "Parallel random
/// numbers: as easy as 1, 2, 3", doi:10.1145/2063384.2063405). Equal to numpy.random.Philox.
constexpr std::array<std::uint64_t, 4> philox(std::array<std::uint64_t, 4> counter,
                                              std::array<std::uint64_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const Uint128 a = product(0xD2E7470EE14C6C93, counter[0]);
    const Uint128 b = product(0xCA5A826395121157, counter[2]);
    counter = {b.high ^ counter[1] ^ key[0], b.low, a.high ^ counter[3] ^ key[1], a.low};
    key[0] += 0x9E3779B97F4A7C15;
    key[1] += 0xBB67AE8584CAA73B;
  }
  return counter;
}

/// Converts the upper 53 bits to a number in [0, 1).
constexpr double unit(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

/// SplitMix64's finaliser (Steele, Lea, Flood 2014): every input bit affects every output bit.
/// Derives keys from keys.
constexpr std::uint64_t mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EB;
  return x ^ (x >> 31);
}

constexpr std::uint64_t mix(std::uint64_t key, std::uint64_t value) {
  return mix(key ^ mix(value));
}

/// Number `use` of the stream `key`, in [0, 1).
constexpr double uniform(std::uint64_t key, std::uint64_t use) {
  return unit(mix(key, use));
}

} // namespace firetwin
