#pragma once

#include "forest/scatter.hpp"

namespace firetwin::forest {

/// Trees of stands, ordered by cell.
struct Stems : Plants {
  Buffer<float> width;      ///< crown width relative to the model
  Buffer<std::int64_t> key; ///< identifier and key of the tree's random numbers
};

/// Generates trees of stands by Matérn hard-core thinning (`MaternProcess`). Stem density and
/// heights follow from the canopy fuel (`stems`, `height`), bilinear between cell centres. Cells
/// with 0.01 kg/m2 or less, or without elevation, have no trees.
///
/// Distances are measured on an equirectangular plane scaled at the grid's centre. Size classes are
/// by height: small below 8 m, large from 22 m. The result is the same for any mask and any number
/// of threads. `jitter` is not used.
///
/// @param retained [fy fx] share of the stems to retain, 0 to 1, bilinear like the fuel: the
/// oldest, hence the largest. Crowns are widened (`crown_widening`) to conserve the summed crown
/// area. Empty: all stems. Values that are not finite count as 0.
Stems stand(std::span<const float> canopy_fuel, const PlantingSite& site,
            std::span<const float> retained);

} // namespace firetwin::forest
