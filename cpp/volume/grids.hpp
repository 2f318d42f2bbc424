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

/// Smoke grids shared by puffs and by a model's own fields.
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

/// Options for writing smoke grids.
struct GridRequest {
  std::vector<SmokeGrid> grids; ///< empty: all; glow and flame only with flames
  Flames flames;
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
