#include "vdb.hpp"

#include "archive.hpp"
#include "error.hpp"

#include <openvdb/tools/Dense.h>

#include <cmath>
#include <mutex>

namespace firetwin {
namespace {

constexpr double kLargestHalf = 65504.0;

} // namespace

openvdb::FloatGrid::Ptr fog_grid(const std::string& name, double voxel_size,
                                 const std::array<double, 3>& origin, const std::string& units) {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
  if (!(voxel_size > 0.0) || !std::isfinite(voxel_size)) {
    throw Error("voxel_size must be a positive length in metres");
  }
  openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0F);
  openvdb::math::Transform::Ptr transform =
      openvdb::math::Transform::createLinearTransform(voxel_size);
  transform->postTranslate(openvdb::Vec3d(origin[0], origin[1], origin[2]));
  grid->setTransform(transform);
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->insertMeta("units", openvdb::StringMetadata(units));
  return grid;
}

VolumeFrame write_dense(const std::string& path, const std::map<std::string, DenseField>& fields,
                        double voxel_size, const std::array<double, 3>& origin, bool half,
                        float tolerance, const Metadata& metadata) {
  openvdb::GridPtrVec grids;
  double mass = 0.0;
  for (const auto& [name, field] : fields) {
    for (const float value : field.values) {
      if (!std::isfinite(value) || (half && std::abs(value) > kLargestHalf)) {
        throw Error("grid \"" + name + "\" holds " + std::to_string(value) +
                    "; give finite numbers, below 65504 for half precision");
      }
    }
    openvdb::FloatGrid::Ptr grid = fog_grid(name, voxel_size, origin, "");
    const openvdb::CoordBBox box(
        openvdb::Coord(0),
        openvdb::Coord(field.shape[0] - 1, field.shape[1] - 1, field.shape[2] - 1));
    // Dense only reads here; its type asks for a pointer to non-const.
    const openvdb::tools::Dense<float, openvdb::tools::LayoutZYX> dense(
        box, const_cast<float*>(field.values.data()));
    openvdb::tools::copyFromDense(dense, grid->tree(), tolerance);
    grid->setSaveFloatAsHalf(half);
    if (name == "density") {
      double sum = 0.0;
      for (auto voxel = grid->cbeginValueOn(); voxel; ++voxel) {
        sum += static_cast<double>(*voxel) * static_cast<double>(voxel.getVoxelCount());
      }
      mass = sum * voxel_size * voxel_size * voxel_size;
    }
    grids.push_back(grid);
  }
  VolumeArchive archive;
  archive.add(grids);
  VolumeFrame frame = archive.write(path, metadata);
  frame.mass = mass;
  return frame;
}

} // namespace firetwin
