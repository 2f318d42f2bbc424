#pragma once

#include "forest/scatter.hpp"

namespace firetwin::forest {

/// Trees of stands, in order of their cells.
struct Stems : Plants {
  Buffer<float> width;      ///< how much wider than its model a crown is drawn
  Buffer<std::int64_t> key; ///< of this tree alone: what is random about it hangs on this
};

/// Stands of as many and as tall trees as the canopy fuel calls for (`stems`, `height`), bilinear
/// between the cells' middles; none in cells with 0.01 kg/m2 or less, or without elevation.
///
/// The trees keep their distance (`Births`), on the plane of longitude and latitude with the scale
/// of the grid's middle. Classes go by height: small below 8 m, large from 22 m. The same for any
/// mask and any number of threads; `jitter` is not asked.
///
/// @param kept [fy fx] part (0 to 1) of the stems to keep, bilinear like the fuel: the oldest and
/// so
///        the largest, with crowns so much wider (`widening`) that they cover the same ground;
///        empty: all. What is not finite counts as 0.
Stems stand(std::span<const float> canopy_fuel, const Site& site, std::span<const float> kept);

} // namespace firetwin::forest
