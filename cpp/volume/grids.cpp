#include "grids.hpp"

namespace firetwin {

std::array<float, 3> corner_of(const openvdb::Coord& origin, float voxel_size) {
  return {static_cast<float>(origin.x()) * voxel_size, static_cast<float>(origin.y()) * voxel_size,
          static_cast<float>(origin.z()) * voxel_size};
}

std::vector<GridName> smoke_grids(bool lit, const std::string& density_units) {
  std::vector<GridName> names{{"density", density_units},
                              {"dilution", "1e-5 kg/m3"},
                              {"shade", "1e-5 kg/m3"},
                              {"size", "km"},
                              {"temperature", "K"}};
  if (lit) {
    names.push_back({"glow", "1"});
  }
  return names;
}

void glow(const openvdb::Coord& origin, float voxel_size, const Flames& flames, LeafValues& out) {
  interpolate(glow_at_nodes(corner_of(origin, voxel_size), voxel_size, flames), out);
}

/// Integral over active voxels.
double mass_of(const LeafMask& mask, const LeafValues& values, double voxel_size) {
  double sum = 0.0;
  for (auto voxel = mask.beginOn(); voxel; ++voxel) {
    sum += static_cast<double>(values[voxel.pos()]);
  }
  return sum * voxel_size * voxel_size * voxel_size;
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

} // namespace firetwin
