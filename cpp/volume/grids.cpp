#include "volume/grids.hpp"

#include "volume/fog.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace firetwin::volume {
namespace {

constexpr double seen_margin = 300.0; // m round a leaf: noise, and light that smoke passes on

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

bool is_wanted(const Wanted& wanted, SmokeGrid grid) {
  const bool lit = grid == SmokeGrid::glow || grid == SmokeGrid::flame;
  if (lit && wanted.flames.power.empty()) {
    return false;
  }
  return wanted.grids.empty() ||
         std::find(wanted.grids.begin(), wanted.grids.end(), grid) != wanted.grids.end();
}

bool counts(const openvdb::Coord& origin, double voxel_size, const lod::Sight& sight) {
  const double middle = 0.5 * static_cast<double>(leaf_side - 1);
  const double half = 0.5 * static_cast<double>(leaf_side) * voxel_size;
  const lod::Ball leaf{{(origin.x() + middle) * voxel_size, (origin.y() + middle) * voxel_size,
                        (origin.z() + middle) * voxel_size},
                       std::sqrt(3.0) * half + seen_margin};
  return sight.counts(leaf, {.shadows = true});
}

/// Power of the flames within 1.5 voxels in GW, at most 1.
openvdb::FloatGrid::Ptr flame_grid(const Flames& flames, double voxel_size) {
  openvdb::FloatGrid::Ptr grid = fog_grid("flame", voxel_size, {0.0, 0.0, 0.0}, "1");
  auto accessor = grid->getAccessor();
  for (std::size_t i = 0; i < flames.power.size(); ++i) {
    const openvdb::Vec3d at(flames.position[3 * i] / voxel_size,
                            flames.position[3 * i + 1] / voxel_size,
                            flames.position[3 * i + 2] / voxel_size);
    const openvdb::Coord low = openvdb::Coord::round(at - openvdb::Vec3d(1.5));
    const openvdb::Coord high = openvdb::Coord::round(at + openvdb::Vec3d(1.5));
    for (auto voxel = openvdb::CoordBBox(low, high).begin(); voxel; ++voxel) {
      const double rest = 1.0 - ((*voxel).asVec3d() - at).length() / 1.5;
      if (rest > 0.0 && flames.power[i] > 0.0) {
        const float value =
            accessor.getValue(*voxel) + static_cast<float>(rest * flames.power[i] / 1.0e9);
        accessor.setValue(*voxel, std::min(value, 1.0F));
      }
    }
  }
  grid->setSaveFloatAsHalf(true);
  return grid;
}

/// The leaves that count.
struct Chosen {
  SharedLeaves leaves;
  std::vector<std::size_t> number; ///< of each among all the source's
  double hidden = 0.0;             ///< kg in the others
};

Chosen choose(const LeafSource& source, double voxel_size, const lod::Sight* sight) {
  const SharedLeaves& all = source.leaves;
  std::vector<char> seen(all.size());
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    seen[i] = sight == nullptr || counts(all.origins[i], voxel_size, *sight) ? 1 : 0;
  });
  Chosen chosen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (seen[i] != 0) {
      chosen.leaves.origins.push_back(all.origins[i]);
      chosen.leaves.masks.push_back(all.masks[i]);
      chosen.number.push_back(i);
    } else {
      LeafValues dilution;
      source.values(i, SmokeGrid::dilution, dilution);
      chosen.hidden += mass_of(all.masks[i], dilution, voxel_size) * fresh_smoke;
    }
  }
  return chosen;
}

} // namespace

SmokeGrid smoke_grid(const std::string& name) {
  std::string known;
  for (const NamedGrid& grid : all_grids) {
    if (name == grid.name) {
      return grid.grid;
    }
    known += (known.empty() ? "" : ", ") + std::string(grid.name);
  }
  throw std::invalid_argument("there is no smoke grid \"" + name + "\"; choose from " + known);
}

Frame write_leaves(const std::filesystem::path& path, const LeafSource& source, double voxel_size,
                   const Wanted& wanted) {
  const Chosen chosen = choose(source, voxel_size, wanted.sight);
  const SharedLeaves& leaves = chosen.leaves;
  std::vector<SmokeGrid> grids;
  std::vector<GridName> names;
  for (const NamedGrid& grid : all_grids) {
    if (grid.grid != SmokeGrid::flame && is_wanted(wanted, grid.grid)) {
      grids.push_back(grid.grid);
      names.push_back({grid.name, grid.grid == SmokeGrid::density ? source.density_units
                                                                  : std::string(grid.units)});
    }
  }
  std::vector<double> mass(leaves.size()); // kg
  VdbArchive archive;
  archive.add(names, voxel_size, leaves, [&](std::size_t i, std::span<LeafValues> out) {
    for (std::size_t g = 0; g < grids.size(); ++g) {
      if (grids[g] == SmokeGrid::glow) {
        const auto voxel = static_cast<float>(voxel_size);
        interpolate(glow_at_nodes(corner_of(leaves.origins[i], voxel), voxel, wanted.flames),
                    out[g]);
        continue;
      }
      source.values(chosen.number[i], grids[g], out[g]);
      if (grids[g] == SmokeGrid::dilution) {
        mass[i] = mass_of(leaves.masks[i], out[g], voxel_size) * fresh_smoke;
      }
    }
  });
  if (is_wanted(wanted, SmokeGrid::flame)) {
    archive.add({flame_grid(wanted.flames, voxel_size)});
  }
  Frame frame = archive.write(path, wanted.metadata);
  frame.mass = std::accumulate(mass.begin(), mass.end(), 0.0);
  frame.hidden = chosen.hidden;
  return frame;
}

} // namespace firetwin::volume
