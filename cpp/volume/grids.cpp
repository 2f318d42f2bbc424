#include "volume/grids.hpp"

#include "volume/archive.hpp"
#include "volume/fog.hpp"
#include "volume/leaf_culling.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <memory>
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

/// Makes the grid of flame power within 1.5 voxels, GW, at most 1.
openvdb::FloatGrid::Ptr flame_grid(const Flames& flames, double voxel_size) {
  openvdb::FloatGrid::Ptr grid = fog_grid("flame", voxel_size, {0.0, 0.0, 0.0}, "1");
  auto accessor = grid->getAccessor();
  for (std::size_t i = 0; i < flames.power.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      leaf_number(flames.position[3 * i + axis], voxel_size); // throws if the index overflows
    }
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

/// Wraps a grid that has its own leaf values.
LeafGrid as_leaf_grid(const openvdb::FloatGrid::Ptr& grid) {
  return {grid, [](const Leaf& leaf, LeafValues& values) {
            std::copy_n(leaf.buffer().data(), leaf_voxels, values.begin());
          }};
}

/// Visible leaves of a source, and their masses.
class VisibleLeaves {
public:
  VisibleLeaves(const LeafSource& source, double voxel_size, const lod::ViewSet* view_set)
      : source_(source), voxel_size_(voxel_size), tree_(std::make_shared<openvdb::FloatTree>()),
        mass_(source.leaves.size()) {
    const SharedLeaves& all = source.leaves;
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
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (visible[i] != 0) {
        auto leaf = std::make_unique<Leaf>(openvdb::PartialCreate(), all.origins[i]);
        leaf->setValueMask(all.masks[i]);
        leaf->setTransientData(static_cast<openvdb::Index32>(i));
        tree_->addLeaf(leaf.release()); // the tree takes ownership
      }
    }
  }

  LeafGrid grid(const NamedGrid& named, const Flames& flames) {
    const bool is_density = named.grid == SmokeGrid::density;
    const openvdb::FloatGrid::Ptr grid =
        fog_grid(named.name, voxel_size_, {0.0, 0.0, 0.0},
                 is_density ? source_.density_units : std::string(named.units));
    grid->setSaveFloatAsHalf(true);
    grid->setTree(tree_);
    if (named.grid == SmokeGrid::glow) {
      return {grid, [this, &flames](const Leaf& leaf, LeafValues& values) {
                const auto voxel = static_cast<float>(voxel_size_);
                interpolate(glow_at_nodes(corner_of(leaf.origin(), voxel), voxel, flames), values);
              }};
    }
    return {grid, [this, wanted = named.grid](const Leaf& leaf, LeafValues& values) {
              const std::size_t i = leaf.transientData();
              source_.values(i, wanted, values);
              if (wanted == SmokeGrid::dilution) {
                mass_[i] = mass_of(leaf.getValueMask(), values, voxel_size_) * fresh_smoke;
              }
            }};
  }

  /// Returns the mass of the written dilution, kg.
  double mass() const { return std::accumulate(mass_.begin(), mass_.end(), 0.0); }
  /// Returns the mass in culled leaves, kg.
  double culled_mass() const { return culled_; }

private:
  const LeafSource& source_;
  double voxel_size_;
  openvdb::FloatTree::Ptr tree_;
  std::vector<double> mass_;
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
  VdbArchive archive;
  for (const NamedGrid& named : all_grids) {
    if (is_wanted(wanted, named.grid)) {
      archive.add(named.grid == SmokeGrid::flame
                      ? as_leaf_grid(flame_grid(wanted.flames, voxel_size))
                      : chosen.grid(named, wanted.flames));
    }
  }
  VdbSummary frame = archive.write(path, wanted.metadata);
  frame.mass = chosen.mass();
  frame.culled_mass = chosen.culled_mass();
  return frame;
}

} // namespace firetwin::volume
