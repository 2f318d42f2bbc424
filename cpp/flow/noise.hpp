#pragma once

#include "flow/lattice.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

/// Noise for detail that the flow's cells are too large for. Alike on any machine to rounding.
namespace firetwin::flow {

/// Numbers of places that are worked on at once.
using Row = std::array<float, static_cast<std::size_t>(lanes)>;

/// Perlin's gradient noise (Perlin 2002, "Improving noise"), about -1 to 1, mean 0; one feature per
/// unit.
void perlin(const Row& x, const Row& y, const Row& z, std::uint32_t seed, Row& noise);

/// Distance to the nearest of points strewn one to a unit cube (Worley 1996, "A cellular texture
/// basis function"), about 0 to 1.2, mean 0.49: lumps with sharp valleys between them. Keeps the
/// points round the last place, so that places which follow each other closely take little time.
class Worley {
public:
  void at(const Row& x, const Row& y, const Row& z, std::uint32_t seed, Row& distance);

  static constexpr std::size_t points = 32; ///< 27, and some far away that fill the last lanes
  struct Points {
    std::array<float, points> x, y, z;
  };

private:
  std::array<std::int32_t, 3> cell_{};
  std::uint32_t seed_ = 0;
  bool strewn_ = false;
  Points points_{};
};

} // namespace firetwin::flow
