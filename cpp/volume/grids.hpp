#pragma once

#include "io/metadata.hpp"
#include "lod/view_set.hpp"
#include "volume/leaf.hpp"
#include "volume/smooth.hpp"
#include "volume/vdb_summary.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// Grids of a model's smoke.
namespace firetwin::volume {

/// Smoke density of dilution 1, kg/m3: 10 mg/m3, as above a crown fire.
constexpr double fresh_smoke = 1.0e-5;

/// Dilution below which smoke is set to clear.
constexpr double min_dilution = 2.0e-3;

/// Densities between which `shade` rises from 0 to `dilution`.
constexpr float edge_low = 0.46F;
constexpr float edge_high = 0.55F;
constexpr float max_temperature = 1500.0F; ///< K

/// Temperature of the International Standard Atmosphere at a height (m), K.
inline float air_kelvin(float height) {
  return 288.15F - 0.0065F * height;
}

enum class SmokeGrid { density, dilution, shade, size, temperature, glow, flame };

/// @throws std::invalid_argument for an unknown name
SmokeGrid smoke_grid(const std::string& name);

/// Options for writing smoke grids:
/// - `density`: 0 in clear air to 1 in thick smoke;
/// - `dilution`: smoke in units of fresh_smoke;
/// - `shade`: `dilution` times a smoothstep of density from edge_low to edge_high: smoke with a
///   sharp edge in one grid, for shadow rays, whose cost is the number of grid lookups;
/// - `size`: length below which only noise adds detail, km, at most 1;
/// - `temperature`: K;
/// - with flames, `glow`: sum of P / 1e9 W exp(-r / 1100 m) / (1 + (r / 250 m)^2), so 1 among
///   flames of 1 GW, and `flame`: power of the flames within 1.5 voxels, GW, at most 1.
struct GridRequest {
  std::vector<SmokeGrid> grids; ///< empty: all; glow and flame only with flames
  FlameLights flames;
  const lod::ViewSet* view_set = nullptr; ///< for culling; null culls nothing
  io::Metadata metadata;
};

/// Smoke data by leaf.
struct LeafSource {
  Leaves leaves;
  std::string density_units;
  /// Computes a leaf's values in one grid, except glow and flame.
  std::function<void(std::size_t leaf, SmokeGrid grid, LeafValues& out)> values;
};

/// Writes the requested grids of the visible leaves (with a margin of 300 m). VdbSummary::mass is
/// the integral of the written dilution, `culled_mass` the mass of the culled leaves.
VdbSummary write_leaves(const std::filesystem::path& path, const LeafSource& source,
                        double voxel_size, const GridRequest& wanted);

} // namespace firetwin::volume
