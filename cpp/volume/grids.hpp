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

/// What smoke grids have in common, whether they come from puffs or from a model's own fields.
namespace firetwin::volume {

/// Smoke that counts as dilution 1, kg/m3: 10 mg/m3, as over a crown fire.
constexpr double fresh_smoke = 1.0e-5;

/// Thinner smoke than this times fresh_smoke is left out.
constexpr double thinnest_dilution = 2.0e-3;

/// Densities where `shade` begins and where it is whole.
constexpr float edge_low = 0.46F;
constexpr float edge_high = 0.55F;
constexpr float hottest = 1500.0F; ///< K

/// International Standard Atmosphere at a height (m), K.
inline float air_kelvin(float height) {
  return 288.15F - 0.0065F * height;
}

enum class SmokeGrid { density, dilution, shade, size, temperature, glow, flame };

/// @throws std::invalid_argument for a name that is not one of them.
SmokeGrid smoke_grid(const std::string& name);

/// Options of writing smoke grids.
struct GridRequest {
  std::vector<SmokeGrid> grids; ///< none: all; glow and flame only with flames
  Flames flames;
  const lod::ViewSet* view_set = nullptr; ///< for culling; null culls nothing
  io::Metadata metadata;
};

/// Leaves that several grids have in common: where they begin and which voxels are active.
struct SharedLeaves {
  std::vector<openvdb::Coord> origins;
  std::vector<LeafMask> masks;

  std::size_t size() const { return origins.size(); }
};

/// Smoke leaf by leaf.
struct LeafSource {
  SharedLeaves leaves;
  std::string density_units;
  /// Values of a leaf in one grid; not asked for glow and flame.
  std::function<void(std::size_t leaf, SmokeGrid grid, LeafValues& out)> values;
};

/// Writes the wanted grids of the visible leaves (with a margin of 300 m). The summary's mass is
/// that of the dilution written, `culled_mass` that of the culled leaves.
VdbSummary write_leaves(const std::filesystem::path& path, const LeafSource& source,
                        double voxel_size, const GridRequest& wanted);

} // namespace firetwin::volume
