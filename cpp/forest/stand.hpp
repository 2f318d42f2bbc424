#pragma once

#include "forest/scatter.hpp"

namespace firetwin::forest {

/// Trees of stands, in order of their cells.
struct Stems : Plants {
  Buffer<float> width;      ///< crown width over the model's
  Buffer<std::int64_t> key; ///< identifier that keys the tree's random numbers
};

/// Trees of stands by Matérn hard-core thinning (`MaternProcess`). Stem density and heights follow
/// from the canopy fuel (`stems`, `height`), bilinear between cell centres. Cells with 0.01 kg/m2
/// or less, or without elevation, have no trees.
///
/// Distances are on the plane of longitude and latitude with the scale of the grid's centre. Size
/// classes go by height: small below 8 m, large from 22 m. The result is the same for any mask and
/// any number of threads. `jitter` is not used.
///
/// @param retained [fy fx] share of the stems to retain, 0 to 1, bilinear like the fuel: the oldest
///        and so the largest. Crowns are widened (`crown_widening`), so that they cover the same
///        ground. Empty: all stems. A value that is not finite counts as 0.
Stems stand(std::span<const float> canopy_fuel, const PlantingSite& site,
            std::span<const float> retained);

} // namespace firetwin::forest
