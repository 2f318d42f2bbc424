#pragma once

#include "base/simd.hpp"

#include <array>
#include <cmath>
#include <cstdint>

/// Value noise at eight points at once, on a lattice hashed in place so that it never repeats.
namespace firetwin::flames {

using LaneIndex = Simd<std::int32_t, lane_count>;
using LaneHash = Simd<std::uint32_t, lane_count>;

/// Offset of the lattice, and the place of the origin in its cell: coordinates keep their precision
/// far from the scene's origin and at late times.
struct LatticeOrigin {
  std::array<std::uint32_t, 3> cell;
  std::array<float, 3> part;
};

/// Splits a coordinate into a cell, wrapped at 2^32, and the place in it.
inline void split_coordinate(double value, std::uint32_t& cell, float& part) {
  const double whole = std::floor(value);
  cell = static_cast<std::uint32_t>(static_cast<std::int64_t>(whole));
  part = static_cast<float>(value - whole);
}

namespace lattice {

__attribute__((always_inline)) inline void floor_of(const Lanes& value, LaneIndex& whole,
                                                    Lanes& part) {
  whole = __builtin_convertvector(value, LaneIndex);
  const Lanes back = __builtin_convertvector(whole, Lanes);
  whole += back > value; // true is -1
  part = value - __builtin_convertvector(whole, Lanes);
}

__attribute__((always_inline)) inline void value_of(const LaneHash& joined, Lanes& out) {
  LaneHash hash = joined ^ (joined >> 15);
  hash *= 0x2c1b3c6dU;
  hash ^= hash >> 12;
  hash *= 0x297a2d39U;
  hash ^= hash >> 15;
  out = __builtin_convertvector((LaneIndex)hash, Lanes) * (1.0F / 2147483648.0F);
}

__attribute__((always_inline)) inline void mix(const Lanes& a, const Lanes& b, const Lanes& part,
                                               Lanes& out) {
  out = a + (b - a) * part;
}

} // namespace lattice

/// Noise, -1 to 1, at lattice coordinates; `slope`, unless null, receives its derivatives.
__attribute__((always_inline)) inline void lattice_noise(const Lanes& x, const Lanes& y,
                                                         const Lanes& z, const LaneHash& cell_z,
                                                         std::uint32_t cell_x, std::uint32_t cell_y,
                                                         Lanes& out, Lanes* slope) {
  LaneIndex i, j, k;
  Lanes a, b, c;
  lattice::floor_of(x, i, a);
  lattice::floor_of(y, j, b);
  lattice::floor_of(z, k, c);
  const LaneHash hx = ((LaneHash)i + cell_x) * 0x8da6b343U;
  const LaneHash hy = ((LaneHash)j + cell_y) * 0xd8163841U;
  const LaneHash hz = ((LaneHash)k + cell_z) * 0xcb1ab31fU;
  const LaneHash hx1 = hx + 0x8da6b343U, hy1 = hy + 0xd8163841U, hz1 = hz + 0xcb1ab31fU;
  Lanes v000, v100, v010, v110, v001, v101, v011, v111;
  lattice::value_of(hx ^ hy ^ hz, v000);
  lattice::value_of(hx1 ^ hy ^ hz, v100);
  lattice::value_of(hx ^ hy1 ^ hz, v010);
  lattice::value_of(hx1 ^ hy1 ^ hz, v110);
  lattice::value_of(hx ^ hy ^ hz1, v001);
  lattice::value_of(hx1 ^ hy ^ hz1, v101);
  lattice::value_of(hx ^ hy1 ^ hz1, v011);
  lattice::value_of(hx1 ^ hy1 ^ hz1, v111);
  const Lanes sa = a * a * (3.0F - 2.0F * a), sb = b * b * (3.0F - 2.0F * b),
              sc = c * c * (3.0F - 2.0F * c);
  Lanes u00, u10, u01, u11, w0, w1;
  lattice::mix(v000, v100, sa, u00);
  lattice::mix(v010, v110, sa, u10);
  lattice::mix(v001, v101, sa, u01);
  lattice::mix(v011, v111, sa, u11);
  lattice::mix(u00, u10, sb, w0);
  lattice::mix(u01, u11, sb, w1);
  lattice::mix(w0, w1, sc, out);
  if (slope != nullptr) {
    Lanes d0, d1;
    lattice::mix(v100 - v000, v110 - v010, sb, d0);
    lattice::mix(v101 - v001, v111 - v011, sb, d1);
    lattice::mix(d0, d1, sc, slope[0]);
    slope[0] *= 6.0F * a * (1.0F - a);
    lattice::mix(u10 - u00, u11 - u01, sc, slope[1]);
    slope[1] *= 6.0F * b * (1.0F - b);
    slope[2] = (w1 - w0) * (6.0F * c * (1.0F - c));
  }
}

} // namespace firetwin::flames
