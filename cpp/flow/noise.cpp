#include "flow/noise.hpp"

#include "base/noise.hpp"
#include "flow/between.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace firetwin::flow {
namespace {

/// A point's cell and its place in it.
struct Place {
  explicit Place(float at)
      : cell(static_cast<std::int32_t>(std::floor(at))), part(at - std::floor(at)) {}
  std::int32_t cell;
  float part;
};

/// Mixes a cell's three numbers into 32 even bits.
std::uint32_t bits(std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t seed) {
  return finished(static_cast<std::uint32_t>(i) * 0x9E3779B1U ^
                  static_cast<std::uint32_t>(j) * 0x85EBCA77U ^
                  static_cast<std::uint32_t>(k) * 0xC2B2AE3DU ^ seed * 0x27D4EB2FU);
}

/// Slope times place, of one of twelve slopes along the diagonals of a cube's faces.
float slope(std::uint32_t h, float x, float y, float z) {
  const std::uint32_t which = h & 15U;
  const float u = which < 8 ? x : y;
  const float v = which < 4 ? y : which == 12 || which == 14 ? x : z;
  return ((which & 1U) != 0 ? -u : u) + ((which & 2U) != 0 ? -v : v);
}

float share(std::uint32_t h, int shift) {
  return static_cast<float>(h >> shift & 1023U) / 1023.0F;
}

} // namespace

float perlin(float x, float y, float z, std::uint32_t seed) {
  const Place a(x), b(y), c(z);
  std::array<float, 2> level{};
  for (int k = 0; k < 2; ++k) {
    std::array<float, 2> row{};
    for (int j = 0; j < 2; ++j) {
      const auto corner = [&](int i) {
        return slope(bits(a.cell + i, b.cell + j, c.cell + k, seed), a.part - static_cast<float>(i),
                     b.part - static_cast<float>(j), c.part - static_cast<float>(k));
      };
      row[static_cast<std::size_t>(j)] = mix(corner(0), corner(1), fade(a.part));
    }
    level[static_cast<std::size_t>(k)] = mix(row[0], row[1], fade(b.part));
  }
  return mix(level[0], level[1], fade(c.part));
}

void Worley::strew(const std::array<std::int32_t, 3>& cell, std::uint32_t seed) {
  constexpr float far_away = 99.0F;
  std::array<float, points> x, y, z;
  x.fill(far_away);
  y.fill(far_away);
  z.fill(far_away);
  std::size_t n = 0;
  for (std::int32_t k = -1; k < 2; ++k) {
    for (std::int32_t j = -1; j < 2; ++j) {
      for (std::int32_t i = -1; i < 2; ++i, ++n) {
        const std::uint32_t h = bits(cell[0] + i, cell[1] + j, cell[2] + k, seed);
        x[n] = static_cast<float>(i) + share(h, 0);
        y[n] = static_cast<float>(j) + share(h, 10);
        z[n] = static_cast<float>(k) + share(h, 20);
      }
    }
  }
  std::memcpy(x_.data(), x.data(), sizeof x);
  std::memcpy(y_.data(), y.data(), sizeof y);
  std::memcpy(z_.data(), z.data(), sizeof z);
  cell_ = cell;
  seed_ = seed;
  strewn_ = true;
}

float Worley::at(float x, float y, float z, std::uint32_t seed) {
  const Place a(x), b(y), c(z);
  const std::array<std::int32_t, 3> cell{a.cell, b.cell, c.cell};
  if (!strewn_ || cell != cell_ || seed != seed_) {
    strew(cell, seed);
  }
  Lanes nearest = Lanes{} + 9.0F;
  for (std::size_t n = 0; n < x_.size(); ++n) {
    const Lanes dx = x_[n] - a.part, dy = y_[n] - b.part, dz = z_[n] - c.part;
    const Lanes square = dx * dx + dy * dy + dz * dz;
    nearest = square < nearest ? square : nearest;
  }
  float least = nearest[0];
  for (int lane = 1; lane < 8; ++lane) {
    least = std::min(least, nearest[lane]);
  }
  return std::sqrt(least);
}

} // namespace firetwin::flow
