#pragma once

#include "flow/lattice.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Procedural noise, equal on all machines up to rounding.
namespace firetwin::flow {

/// Values at a row of positions (SIMD lanes).
using Row = std::array<float, static_cast<std::size_t>(lanes)>;

/// Perlin's gradient noise (Perlin 2002, "Improving noise"), about -1 to 1, mean 0; one feature per
/// unit.
void perlin(const Row& x, const Row& y, const Row& z, std::uint32_t seed, Row& noise);

/// Worley (cellular) noise: distance to the nearest feature point, one point per unit cube (Worley
/// 1996, "A cellular texture basis function"). It is about 0 to 1.2, with mean 0.49, and looks like
/// billows with sharp valleys. The points around recent cubes are cached.
class Worley {
public:
  Worley() : cache_(cache_size) {}

  void at(const Row& x, const Row& y, const Row& z, std::uint32_t seed, Row& distance);

  static constexpr std::size_t points = 32; ///< 27, padded to full lanes with far-away points
  /// Points that may be the nearest in a cube, padded to full lanes.
  struct Points {
    std::array<float, points> x, y, z;
    std::size_t count = 0; ///< in full lanes; 0: not computed yet
    std::array<std::int32_t, 3> cell{};
    std::uint32_t seed = 0;
  };

private:
  static constexpr std::size_t cache_size = 256;

  const Points& around(const std::array<std::int32_t, 3>& cell, std::uint32_t seed);

  std::vector<Points> cache_; ///< hashed by the last bits of the cube
};

} // namespace firetwin::flow
