#include "smoke.hpp"

#include "bins.hpp"
#include "error.hpp"
#include "leaf.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace firetwin {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr float kEdgeLow = 0.46F;
constexpr float kEdgeHigh = 0.55F;
constexpr float kGroundKelvin = 288.15F; // International Standard Atmosphere
constexpr float kLapse = 0.0065F;        // K/m
constexpr float kHeatOfAir = 1206.0F;    // J/(m3 K)
constexpr float kHottest = 1500.0F;      // K

/// One leaf of each grid; empty where there is no smoke.
struct Leaves {
  std::unique_ptr<Leaf> density, dilution, shade, size, temperature, glow;
  double mass = 0.0; // kg, by the sum over active voxels
};

/// A leaf with the voxels of `mask` active and value(voxel) in them.
template <typename Value>
std::unique_ptr<Leaf> make_leaf(const openvdb::Coord& origin, const Leaf::NodeMaskType& mask,
                                Value value) {
  auto leaf = std::make_unique<Leaf>(origin, 0.0F);
  float* buffer = leaf->buffer().data();
  for (auto voxel = mask.beginOn(); voxel; ++voxel) {
    buffer[voxel.pos()] = value(voxel.pos());
  }
  leaf->setValueMask(mask);
  return leaf;
}

Leaves fill(const Puffs& puffs, std::span<const std::uint32_t> balls, const openvdb::Coord& origin,
            float voxel, const Flames& flames) {
  Leaves leaves;
  LeafFields fields({static_cast<float>(origin.x()) * voxel, static_cast<float>(origin.y()) * voxel,
                     static_cast<float>(origin.z()) * voxel},
                    voxel);
  if (!fields.measure(puffs, balls)) {
    return leaves;
  }
  fields.concentrate(puffs, balls);
  Leaf::NodeMaskType mask;
  for (std::uint32_t i = 0; i < LeafFields::kVoxels; ++i) {
    if (fields.distance()[i] > -kOutside &&
        fields.concentration()[i] > static_cast<float>(kThinnest * kFreshSmoke)) {
      mask.setOn(i);
    }
  }
  if (mask.isOff()) {
    return leaves;
  }
  for (auto at = mask.beginOn(); at; ++at) {
    leaves.mass += static_cast<double>(fields.concentration()[at.pos()]);
  }
  leaves.mass *= std::pow(static_cast<double>(voxel), 3);
  const auto heat = static_cast<float>(puffs.heat_per_smoke) / kHeatOfAir;
  leaves.density = make_leaf(origin, mask, [&](std::uint32_t i) {
    return std::clamp((fields.distance()[i] + kInside) / (2.0F * kInside), 0.0F, 1.0F);
  });
  leaves.dilution =
      make_leaf(origin, mask, [&](std::uint32_t i) { return fields.concentration()[i]; });
  leaves.shade = make_leaf(origin, mask, [&](std::uint32_t i) {
    const float depth = (fields.distance()[i] + kInside) / (2.0F * kInside);
    const float t = std::clamp((depth - kEdgeLow) / (kEdgeHigh - kEdgeLow), 0.0F, 1.0F);
    return fields.concentration()[i] * t * t * (3.0F - 2.0F * t);
  });
  leaves.size = make_leaf(
      origin, mask, [&](std::uint32_t i) { return std::min(fields.radius()[i] / 1000.0F, 1.0F); });
  leaves.temperature = make_leaf(origin, mask, [&](std::uint32_t i) {
    const float air = kGroundKelvin - kLapse * fields.height(i % LeafFields::kSide);
    return std::min(air + heat * fields.concentration()[i], kHottest);
  });
  if (!flames.power.empty()) {
    fields.light(flames);
    leaves.glow = make_leaf(origin, mask, [&](std::uint32_t i) { return fields.glow()[i]; });
  }
  return leaves;
}

/// Multiplies the active voxels of one leaf each.
void scale(std::vector<Leaves>& all, std::unique_ptr<Leaf> Leaves::* member, float factor) {
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    if (const auto& leaf = all[i].*member) {
      float* buffer = leaf->buffer().data();
      std::transform(buffer, buffer + Leaf::SIZE, buffer, [&](float v) { return v * factor; });
    }
  });
}

openvdb::FloatGrid::Ptr assemble(std::vector<Leaves>& all, std::unique_ptr<Leaf> Leaves::* member,
                                 const std::string& name, double voxel_size,
                                 const std::string& units) {
  openvdb::FloatGrid::Ptr grid = fog_grid(name, voxel_size, {0.0, 0.0, 0.0}, units);
  for (Leaves& leaves : all) {
    if (leaves.*member) {
      grid->tree().addLeaf((leaves.*member).release()); // the tree owns it now
    }
  }
  grid->setSaveFloatAsHalf(true);
  return grid;
}

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

} // namespace

VolumeFrame write_smoke(const std::string& path, const Puffs& puffs, double voxel_size,
                        const Flames& flames, const Metadata& metadata) {
  fog_grid("check", voxel_size, {0.0, 0.0, 0.0}, ""); // reports a bad voxel size
  std::vector<float> reach(puffs.size());
  double total = 0.0;
  for (std::size_t i = 0; i < reach.size(); ++i) {
    const float radius = puffs.radius[i];
    reach[i] = radius > 0.0F ? radius + kOutside : 0.0F;
    if (puffs.mass[i] > 0.0) {
      reach[i] = std::max(reach[i], spread(radius));
      total += puffs.mass[i];
    }
  }
  const Bins bins(puffs, reach, voxel_size);
  std::vector<Leaves> all(bins.size());
  tbb::parallel_for(std::size_t{0}, bins.size(), [&](std::size_t leaf) {
    if (!bins.balls(leaf).empty()) {
      all[leaf] =
          fill(puffs, bins.balls(leaf), bins.origin(leaf), static_cast<float>(voxel_size), flames);
    }
  });
  std::erase_if(all, [](const Leaves& leaves) { return !leaves.density; });

  double mass = 0.0;
  for (const Leaves& leaves : all) {
    mass += leaves.mass;
  }
  if (mass > 0.0) {
    const auto factor = static_cast<float>(total / mass / kFreshSmoke);
    scale(all, &Leaves::dilution, factor);
    scale(all, &Leaves::shade, factor);
  }
  openvdb::GridPtrVec grids{
      assemble(all, &Leaves::density, "density", voxel_size, "(m + 300) / 600"),
      assemble(all, &Leaves::dilution, "dilution", voxel_size, "1e-5 kg/m3"),
      assemble(all, &Leaves::shade, "shade", voxel_size, "1e-5 kg/m3"),
      assemble(all, &Leaves::size, "size", voxel_size, "km"),
      assemble(all, &Leaves::temperature, "temperature", voxel_size, "K")};
  if (!flames.power.empty()) {
    grids.push_back(assemble(all, &Leaves::glow, "glow", voxel_size, "1"));
    grids.push_back(flame_grid(flames, voxel_size));
  }
  VolumeFrame frame = write_grids(path, grids, metadata);
  frame.mass = mass > 0.0 ? total : 0.0;
  return frame;
}

} // namespace firetwin
