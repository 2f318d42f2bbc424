#include "volume/dense.hpp"

#include "base/check.hpp"
#include "volume/archive.hpp"
#include "volume/fog.hpp"

#include <openvdb/tools/Dense.h>

#include <cmath>
#include <stdexcept>

namespace firetwin::volume {
namespace {

constexpr float largest_half = 65504.0F;

void check_values(const std::string& name, std::span<const float> values, bool half) {
  for (const float value : values) {
    if (!std::isfinite(value) || (half && std::abs(value) > largest_half)) {
      throw std::invalid_argument("grid \"" + name + "\" holds " + std::to_string(value) +
                                  "; give finite numbers, below 65504 for half precision");
    }
  }
}

void copy(const DenseField& field, float tolerance, openvdb::FloatGrid& grid) {
  const openvdb::Coord last(field.shape[0] - 1, field.shape[1] - 1, field.shape[2] - 1);
  // Dense only reads here; its type asks for a pointer to non-const.
  const openvdb::tools::Dense<float, openvdb::tools::LayoutZYX> dense(
      openvdb::CoordBBox(openvdb::Coord(0), last), const_cast<float*>(field.values.data()));
  openvdb::tools::copyFromDense(dense, grid.tree(), tolerance);
}

double sum_of(const openvdb::FloatGrid& grid) {
  double sum = 0.0;
  for (auto voxel = grid.cbeginValueOn(); voxel; ++voxel) {
    sum += static_cast<double>(*voxel) * static_cast<double>(voxel.getVoxelCount());
  }
  return sum;
}

} // namespace

Frame write_dense(const std::filesystem::path& path,
                  const std::map<std::string, DenseField>& fields, double voxel_size,
                  const Vector& origin, bool half, float tolerance, const io::Metadata& metadata) {
  check_above_zero(voxel_size, "voxel_size");
  openvdb::GridPtrVec grids;
  double mass = 0.0;
  for (const auto& [name, field] : fields) {
    check_values(name, field.values, half);
    const openvdb::FloatGrid::Ptr grid = fog_grid(name, voxel_size, origin, "");
    copy(field, tolerance, *grid);
    grid->setSaveFloatAsHalf(half);
    if (name == "density") {
      mass = sum_of(*grid) * voxel_size * voxel_size * voxel_size;
    }
    grids.push_back(grid);
  }
  VdbArchive archive;
  archive.add(grids);
  Frame frame = archive.write(path, metadata);
  frame.mass = mass;
  return frame;
}

} // namespace firetwin::volume
