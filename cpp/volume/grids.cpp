#include "volume/grids.hpp"

#include "volume/archive.hpp"
#include "volume/leaf_culling.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <stdexcept>

namespace firetwin::volume {
namespace {

struct NamedGrid {
  SmokeGrid grid;
  const char* name;
  const char* units;
};

constexpr std::array<NamedGrid, 7> all_grids{{{SmokeGrid::density, "density", ""},
                                              {SmokeGrid::dilution, "dilution", "1e-5 kg/m3"},
                                              {SmokeGrid::shade, "shade", "1e-5 kg/m3"},
                                              {SmokeGrid::size, "size", "km"},
                                              {SmokeGrid::temperature, "temperature", "K"},
                                              {SmokeGrid::glow, "glow", "1"},
                                              {SmokeGrid::flame, "flame", "1"}}};

bool is_wanted(const GridRequest& wanted, SmokeGrid grid) {
  const bool lit = grid == SmokeGrid::glow || grid == SmokeGrid::flame;
  if (lit && wanted.flames.power.empty()) {
    return false;
  }
  return wanted.grids.empty() ||
         std::find(wanted.grids.begin(), wanted.grids.end(), grid) != wanted.grids.end();
}

struct FlameLeaf {
  LeafMask mask;
  LeafValues values{};
};
using FlameLeaves = std::map<Coord, FlameLeaf>; // by first voxel

/// Adds the power of a flame to the voxels within 1.5 voxels, GW; a voxel has at most 1.
void add_flame(const double* position, double power, double voxel_size, FlameLeaves& leaves) {
  Vector at{};
  Coord low;
  Coord high;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    leaf_number(position[axis], voxel_size); // throws if the index overflows
    at[axis] = position[axis] / voxel_size;
    low[axis] = static_cast<std::int32_t>(std::floor(at[axis] - 1.5 + 0.5));
    high[axis] = static_cast<std::int32_t>(std::floor(at[axis] + 1.5 + 0.5));
  }
  constexpr auto last = static_cast<std::int32_t>(leaf_side - 1);
  for (std::int32_t x = low.x(); x <= high.x(); ++x) {
    for (std::int32_t y = low.y(); y <= high.y(); ++y) {
      for (std::int32_t z = low.z(); z <= high.z(); ++z) {
        const Vector offset{x - at[0], y - at[1], z - at[2]};
        const double rest = 1.0 - std::sqrt(dot(offset, offset)) / 1.5;
        if (rest > 0.0 && power > 0.0) {
          FlameLeaf& leaf = leaves[{x & ~last, y & ~last, z & ~last}];
          const auto voxel =
              static_cast<std::size_t>(((x & last) * 8 + (y & last)) * 8 + (z & last));
          leaf.mask.set(voxel);
          const float value = leaf.values[voxel] + static_cast<float>(rest * power / 1.0e9);
          leaf.values[voxel] = std::min(value, 1.0F);
        }
      }
    }
  }
}

FogGrid flame_grid(const FlameLights& flames, double voxel_size) {
  FlameLeaves all;
  for (std::size_t i = 0; i < flames.power.size(); ++i) {
    add_flame(&flames.position[3 * i], flames.power[i], voxel_size, all);
  }
  Leaves leaves;
  std::vector<LeafValues> by_leaf;
  for (const auto& [origin, leaf] : all) {
    leaves.add(origin, leaf.mask);
    by_leaf.push_back(leaf.values);
  }
  return {.name = "flame",
          .units = "1",
          .voxel_size = voxel_size,
          .topology = Topology(leaves),
          .fill = [by_leaf = std::move(by_leaf)](const Coord&, std::size_t leaf,
                                                 LeafValues& values) { values = by_leaf[leaf]; }};
}

/// Visible leaves of a source, and their masses.
class VisibleLeaves {
public:
  VisibleLeaves(const LeafSource& source, double voxel_size, const lod::ViewSet* view_set)
      : source_(source), voxel_size_(voxel_size) {
    const Leaves& all = source.leaves;
    const LeafCulling culling(view_set, voxel_size, {0.0, 0.0, 0.0});
    std::vector<char> visible(all.size());
    std::vector<double> culled(all.size());
    tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
      visible[i] = culling.is_visible(all.origins[i], static_cast<int>(leaf_side)) ? 1 : 0;
      if (visible[i] == 0) {
        LeafValues dilution;
        source.values(i, SmokeGrid::dilution, dilution);
        culled[i] = mass_of(all.masks[i], dilution, voxel_size) * fresh_smoke;
      }
    });
    culled_ = std::accumulate(culled.begin(), culled.end(), 0.0);
    Leaves leaves;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (visible[i] != 0) {
        numbers_.push_back(i);
        leaves.add(all.origins[i], all.masks[i]);
      }
    }
    topology_ = Topology(leaves);
    mass_.resize(leaves.size());
  }

  FogGrid grid(const NamedGrid& named, const FlameLights& flames) {
    const bool is_density = named.grid == SmokeGrid::density;
    FogGrid grid{.name = named.name,
                 .units = is_density ? source_.density_units : named.units,
                 .voxel_size = voxel_size_,
                 .topology = topology_,
                 .fill = {}};
    if (named.grid == SmokeGrid::glow) {
      grid.fill = [this, &flames](const Coord& origin, std::size_t, LeafValues& values) {
        const auto voxel = static_cast<float>(voxel_size_);
        interpolate(glow_at_nodes(corner_of(origin, voxel), voxel, flames), values);
      };
    } else {
      grid.fill = [this, wanted = named.grid](const Coord&, std::size_t leaf, LeafValues& values) {
        const std::size_t i = numbers_[leaf];
        source_.values(i, wanted, values);
        if (wanted == SmokeGrid::dilution) {
          mass_[leaf] = mass_of(source_.leaves.masks[i], values, voxel_size_) * fresh_smoke;
        }
      };
    }
    return grid;
  }

  /// Returns the mass of the written dilution, kg.
  double mass() const { return std::accumulate(mass_.begin(), mass_.end(), 0.0); }
  /// Returns the mass in culled leaves, kg.
  double culled_mass() const { return culled_; }

private:
  const LeafSource& source_;
  double voxel_size_;
  std::vector<std::size_t> numbers_; ///< of the visible leaves in the source
  Topology topology_;
  std::vector<double> mass_; ///< by visible leaf
  double culled_ = 0.0;
};

} // namespace

SmokeGrid smoke_grid(const std::string& name) {
  std::string known;
  for (const NamedGrid& grid : all_grids) {
    if (name == grid.name) {
      return grid.grid;
    }
    known += (known.empty() ? "" : ", ") + std::string(grid.name);
  }
  throw std::invalid_argument("unknown smoke grid \"" + name + "\"; choose from " + known);
}

VdbSummary write_leaves(const std::filesystem::path& path, const LeafSource& source,
                        double voxel_size, const GridRequest& wanted) {
  VisibleLeaves chosen(source, voxel_size, wanted.view_set);
  std::vector<FogGrid> grids;
  for (const NamedGrid& named : all_grids) {
    if (is_wanted(wanted, named.grid)) {
      grids.push_back(named.grid == SmokeGrid::flame ? flame_grid(wanted.flames, voxel_size)
                                                     : chosen.grid(named, wanted.flames));
    }
  }
  VdbSummary frame = write_vdb(path, grids, wanted.metadata);
  frame.mass = chosen.mass();
  frame.culled_mass = chosen.culled_mass();
  return frame;
}

} // namespace firetwin::volume
