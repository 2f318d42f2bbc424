#pragma once

#include "volume/grids.hpp"
#include "volume/puffs.hpp"

#include <filesystem>

namespace firetwin::volume {

/// Writes smoke as the grids of one sparse OpenVDB file (half precision):
/// - `density`: clamp((d + 300 m) / 600 m, 0, 1), with d the depth inside the union of the balls;
///   inactive and 0 farther than 150 m outside, and in voxels of dilution below 0.002 (invisible);
/// - `dilution`: smoke in units of fresh_smoke. Each puff is spread as
///   21 / (16 pi s^3) (1 - r^4 / s^4), s = 1.5 R + 60 m but at least 3.6 voxels; the sum is scaled
///   so that the grid has the mass of the puffs;
/// - `shade`: `dilution` times a smoothstep of density from 0.46 to 0.55: smoke with a sharp edge
///   in one grid, for shadow rays, whose cost is the number of grid lookups;
/// - `size`: radius of the ball that the voxel is in or next to, km, at most 1;
/// - `temperature`: K, the air at that height (ISA) plus the heat of the smoke;
/// - with flames, `glow`: sum of P / 1e9 W exp(-r / 1100 m) / (1 + (r / 250 m)^2), so 1 among
///   flames of 1 GW, and `flame`: power of the flames within 1.5 voxels, GW, at most 1.
VdbSummary write_smoke(const std::filesystem::path& path, const Puffs& puffs, double voxel_size,
                       const GridRequest& wanted);

} // namespace firetwin::volume
