#include "volume/smoke.hpp"

#include "base/smoothstep.hpp"
#include "volume/grids.hpp"
#include "volume/leaf_bins.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <numeric>
#include <vector>

namespace firetwin::volume {
namespace {

constexpr auto thinnest_smoke = static_cast<float>(min_dilution * fresh_smoke); // kg/m3
constexpr float heat_of_air = 1206.0F;                                          // J/(m3 K)

/// Data of a leaf with smoke, before the total mass is known.
struct SmokeLeaf {
  Coord origin;
  LeafMask mask;
  LeafValues depth, radius, concentration;
  double mass = 0.0; // kg, summed over active voxels
};

/// Returns the mask of blocks of 2^3 voxels that contain thick smoke, for DepthMeter::measure.
std::uint64_t thick_blocks(const LeafValues& concentration) {
  std::uint64_t blocks = 0;
  for (std::size_t i = 0; i < leaf_voxels; ++i) {
    if (concentration[i] > thinnest_smoke) {
      blocks |= std::uint64_t{1} << ((i / 128 * 4 + i / 16 % 4) * 4 + i / 2 % 4);
    }
  }
  return blocks;
}

using SmokeLeaves = std::vector<std::unique_ptr<SmokeLeaf>>;

/// Computes the leaves with smoke.
SmokeLeaves fill(const Puffs& puffs, double voxel_size) {
  const auto voxel = static_cast<float>(voxel_size);
  std::vector<float> reach(puffs.size());
  std::vector<float> edge(puffs.size());
  for (std::size_t i = 0; i < puffs.size(); ++i) {
    edge[i] = puffs.radius[i] > 0.0F ? puffs.radius[i] + depth_outside : 0.0F;
    reach[i] = puffs.mass[i] > 0.0 ? spread(puffs.radius[i], voxel) : 0.0F;
  }
  const LeafBox box(puffs, reach, voxel_size); // without mass there is no smoke
  const LeafBins with_mass(box, puffs, reach, voxel_size);
  const LeafBins near(box, puffs, edge, voxel_size);
  const SpreadMass smoke(puffs, voxel);
  std::vector<SmokeLeaves> planes(box.planes());
  tbb::enumerable_thread_specific<DepthMeter> meters;
  tbb::parallel_for(std::size_t{0}, planes.size(), [&](std::size_t plane) {
    const LeafBins::Plane masses(with_mass, plane);
    const LeafBins::Plane edges(near, plane);
    for (std::size_t i = 0; i < box.leaves_in_plane(); ++i) {
      if (masses.balls(i).empty() || edges.balls(i).empty()) {
        continue;
      }
      const Coord origin = box.origin(plane, i);
      const std::array<float, 3> corner = corner_of(origin, voxel);
      const Nodes nodes = smoke.at_nodes(corner, voxel, masses.balls(i));
      if (largest(nodes) <= static_cast<double>(thinnest_smoke)) {
        continue;
      }
      auto leaf = std::make_unique<SmokeLeaf>();
      interpolate(nodes, leaf->concentration);
      meters.local().measure(puffs, edges.balls(i), corner, voxel,
                             thick_blocks(leaf->concentration), leaf->depth, leaf->radius);
      for (std::size_t at = 0; at < leaf_voxels; ++at) {
        if (leaf->depth[at] > -depth_outside && leaf->concentration[at] > thinnest_smoke) {
          leaf->mask.set(at);
        }
      }
      if (!leaf->mask.is_empty()) {
        leaf->origin = origin;
        leaf->mass = mass_of(leaf->mask, leaf->concentration, voxel_size);
        planes[plane].push_back(std::move(leaf));
      }
    }
  });
  SmokeLeaves leaves;
  for (SmokeLeaves& plane : planes) {
    std::move(plane.begin(), plane.end(), std::back_inserter(leaves));
  }
  return leaves;
}

/// Computes the grids of write_smoke; `factor` converts kg/m3 to dilution.
class Values {
public:
  Values(float voxel, float factor, float heat_per_smoke)
      : voxel_(voxel), factor_(factor), heat_(heat_per_smoke / heat_of_air) {}

  void fill(const SmokeLeaf& leaf, SmokeGrid grid, LeafValues& out) const {
    switch (grid) {
    case SmokeGrid::density:
      return density(leaf, out);
    case SmokeGrid::dilution:
      return dilution(leaf, out);
    case SmokeGrid::shade:
      return shade(leaf, out);
    case SmokeGrid::size:
      return size(leaf, out);
    default:
      return temperature(leaf, out);
    }
  }

private:
  void density(const SmokeLeaf& leaf, LeafValues& out) const {
    for (std::size_t i = 0; i < leaf_voxels; ++i) {
      out[i] = std::clamp(part(leaf, i), 0.0F, 1.0F);
    }
  }
  void dilution(const SmokeLeaf& leaf, LeafValues& out) const {
    for (std::size_t i = 0; i < leaf_voxels; ++i) {
      out[i] = leaf.concentration[i] * factor_;
    }
  }
  void shade(const SmokeLeaf& leaf, LeafValues& out) const {
    for (std::size_t i = 0; i < leaf_voxels; ++i) {
      out[i] = leaf.concentration[i] * smoothstep(edge_low, edge_high, part(leaf, i)) * factor_;
    }
  }
  void size(const SmokeLeaf& leaf, LeafValues& out) const {
    for (std::size_t i = 0; i < leaf_voxels; ++i) {
      out[i] = std::min(leaf.radius[i] / 1000.0F, 1.0F);
    }
  }
  void temperature(const SmokeLeaf& leaf, LeafValues& out) const {
    const float low = static_cast<float>(leaf.origin.z()) * voxel_;
    for (std::size_t i = 0; i < leaf_voxels; ++i) {
      const float height = low + static_cast<float>(i % leaf_side) * voxel_;
      out[i] = std::min(air_kelvin(height) + heat_ * leaf.concentration[i], max_temperature);
    }
  }

  static float part(const SmokeLeaf& leaf, std::size_t i) {
    return (leaf.depth[i] + depth_inside) / (2.0F * depth_inside);
  }

  float voxel_;
  float factor_;
  float heat_;
};

} // namespace

VdbSummary write_smoke(const std::filesystem::path& path, const Puffs& puffs, double voxel_size,
                       const GridRequest& wanted) {
  check_voxel_size(voxel_size);
  const SmokeLeaves all = fill(puffs, voxel_size);
  LeafSource source;
  source.density_units = "(m + 300) / 600";
  double mass = 0.0;
  for (const auto& leaf : all) {
    source.leaves.add(leaf->origin, leaf->mask);
    mass += leaf->mass;
  }
  const double total = std::accumulate(puffs.mass.begin(), puffs.mass.end(), 0.0);
  const double factor = mass > 0.0 ? total / mass / fresh_smoke : 0.0;
  const Values values(static_cast<float>(voxel_size), static_cast<float>(factor),
                      static_cast<float>(puffs.heat_per_smoke));
  source.values = [&](std::size_t leaf, SmokeGrid grid, LeafValues& out) {
    values.fill(*all[leaf], grid, out);
  };
  return write_leaves(path, source, voxel_size, wanted);
}

} // namespace firetwin::volume
