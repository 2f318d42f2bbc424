#pragma once

#include <cstdint>

namespace firetwin {

/// SplitMix64's finaliser (Steele, Lea, Flood 2014): every input bit changes every output bit.
constexpr std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

constexpr std::uint64_t mix(std::uint64_t key, std::uint64_t value) {
  return mix(key ^ mix(value));
}

/// A stateless stream of uniform numbers: the `use`-th number of `key`, in [0, 1).
constexpr double uniform(std::uint64_t key, std::uint64_t use) {
  return static_cast<double>(mix(key, use) >> 11) * 0x1.0p-53;
}

} // namespace firetwin
