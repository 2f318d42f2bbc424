#pragma once

#include "flow/lattice.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Procedural noise, the same on any machine up to rounding.
namespace firetwin::flow {

/// Values of a row of places (SIMD lanes).
using Row = std::array<float, static_cast<std::size_t>(lanes)>;

/// Perlin's gradient noise (Perlin 2002, "Improving noise"), about -1 to 1, mean 0; one feature per
/// unit.
void perlin(const Row& x, const Row& y, const Row& z, std::uint32_t seed, Row& noise);

/// Worley (cellular) noise: distance to the nearest feature point, one point per unit cube (Worley
/// 1996, "A cellular texture basis function"). It is about 0 to 1.2, mean 0.49. It looks like
/// billows with sharp valleys. The points round recent cubes are cached.
class Worley {
public:
  Worley() : strewn_(kept) {}

  void at(const Row& x, const Row& y, const Row& z, std::uint32_t seed, Row& distance);

  static constexpr std::size_t points = 32; ///< 27, and some far away that fill the last lanes
  /// Those that may be the nearest to a place in a cube, and others that make the lanes whole.
  struct Points {
    std::array<float, points> x, y, z;
    std::size_t count = 0; ///< in whole lanes; 0: none were strewn yet
    std::array<std::int32_t, 3> cell{};
    std::uint32_t seed = 0;
  };

private:
  static constexpr std::size_t kept = 256;

  const Points& around(const std::array<std::int32_t, 3>& cell, std::uint32_t seed);

  std::vector<Points> strewn_; ///< by the last bits of their cubes
};

} // namespace firetwin::flow
