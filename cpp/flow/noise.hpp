#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// Noise for detail that the flow's cells are too large for. Alike on any machine to rounding.
namespace firetwin::flow {

/// Perlin's gradient noise (Perlin 2002, "Improving noise"), about -1 to 1, mean 0; one feature per
/// unit.
float perlin(float x, float y, float z, std::uint32_t seed);

/// Distance to the nearest of points strewn one to a unit cube (Worley 1996, "A cellular texture
/// basis function"), about 0 to 1.2, mean 0.49: lumps with sharp valleys between them. Keeps the
/// points round the last place, so that places which follow each other closely take little time.
class Worley {
public:
  float at(float x, float y, float z, std::uint32_t seed);

private:
  static constexpr std::size_t points = 32; ///< 27, and some far away that fill the last lanes
  using Lanes = float __attribute__((vector_size(8 * sizeof(float))));

  void strew(const std::array<std::int32_t, 3>& cell, std::uint32_t seed);

  std::array<std::int32_t, 3> cell_{};
  std::uint32_t seed_ = 0;
  bool strewn_ = false;
  std::array<Lanes, points / 8> x_{}, y_{}, z_{};
};

} // namespace firetwin::flow
