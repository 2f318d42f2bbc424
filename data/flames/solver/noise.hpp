#pragma once

#include <cmath>
#include <cstdint>

namespace flame_solver {

/// Finalizer of a hash (Wellons, "lowbias32").
inline std::uint32_t finalize(std::uint32_t h) {
  h ^= h >> 16U;
  h *= 0x7feb352dU;
  h ^= h >> 15U;
  h *= 0x846ca68bU;
  return h ^ h >> 16U;
}

/// Random number from -1 to 1 at a lattice point.
inline float random_value(int i, int j, int k, std::uint32_t seed) {
  constexpr float scale = 2.0F / 16777216.0F;
  const std::uint32_t h = static_cast<std::uint32_t>(i) * 0x9e3779b9U +
                          static_cast<std::uint32_t>(j) * 0x85ebca6bU +
                          static_cast<std::uint32_t>(k) * 0xc2b2ae35U + seed * 0x27d4eb2fU;
  return static_cast<float>(finalize(h) >> 8U) * scale - 1.0F;
}

/// Value noise from -1 to 1: smooth, with features of size 1, periodic along y after `period`.
inline float noise(float x, float y, float z, int period, std::uint32_t seed) {
  const float fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  const int i = static_cast<int>(fx), k = static_cast<int>(fz);
  const int j = (static_cast<int>(fy) % period + period) % period, m = j + 1 == period ? 0 : j + 1;
  const auto smooth = [](float t) { return t * t * (3.0F - 2.0F * t); };
  const float a = smooth(x - fx), b = smooth(y - fy), c = smooth(z - fz);
  const auto line = [&](int row, int level) {
    const float left = random_value(i, row, level, seed);
    return left + a * (random_value(i + 1, row, level, seed) - left);
  };
  const auto plane = [&](int level) {
    const float left = line(j, level);
    return left + b * (line(m, level) - left);
  };
  const float low = plane(k);
  return low + c * (plane(k + 1) - low);
}

} // namespace flame_solver
