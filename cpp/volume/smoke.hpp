#pragma once

#include "volume/grids.hpp"
#include "volume/puffs.hpp"

#include <filesystem>

namespace firetwin::volume {

/// Writes the smoke as grids of one sparse OpenVDB file (half precision):
/// - `density`: clamp((d + 300 m) / 600 m, 0, 1), d the distance into the union of the balls; 0 and
///   inactive farther than 150 m outside, and where dilution is under 0.002, too thin to be seen;
/// - `dilution`: smoke in units of fresh_smoke; each puff spread by
///   21 / (16 pi s^3) (1 - r^4 / s^4), s = 1.5 R + 60 m but at least 3.6 voxels, the whole scaled
///   so that the grid holds the puffs' mass;
/// - `shade`: `dilution`, but falling to 0 as a smoothstep of density from 0.46 to 0.55: smoke
///   with a plain edge in one grid, for rays of light, whose cost is looking grids up;
/// - `size`: radius of the ball that the voxel lies in or next to, km, at most 1;
/// - `temperature`: K, of the air at that height (ISA) plus what the smoke's own heat adds;
/// - with flames, `glow`: sum of P / 1e9 W exp(-r / 1100 m) / (1 + (r / 250 m)^2), so 1 amid flames
///   of 1 GW, and `flame`: power of the flames within 1.5 voxels in GW, at most 1.
VdbSummary write_smoke(const std::filesystem::path& path, const Puffs& puffs, double voxel_size,
                       const GridRequest& wanted);

} // namespace firetwin::volume
