#pragma once

#include <cstdint>

/// Noise for detail that the flow's cells are too large for. Alike on any machine to rounding.
namespace firetwin::flow {

/// Perlin's gradient noise (Perlin 2002, "Improving noise"), about -1 to 1, mean 0; one feature per
/// unit.
float perlin(float x, float y, float z, std::uint32_t seed);

/// Distance to the nearest of points strewn one to a unit cube (Worley 1996, "A cellular texture
/// basis function"), about 0 to 1.2, mean 0.49: lumps with sharp valleys between them.
float worley(float x, float y, float z, std::uint32_t seed);

} // namespace firetwin::flow
