#include "vdb.hpp"

#include "error.hpp"
#include "system.hpp"

#include <openvdb/io/File.h>
#include <openvdb/tools/Dense.h>

#include <cmath>
#include <filesystem>
#include <mutex>
#include <system_error>

namespace firetwin {
namespace {

namespace fs = std::filesystem;

constexpr double kLargestHalf = 65504.0;

/// Removes the temporary file unless it was renamed.
class Temporary {
public:
  explicit Temporary(const fs::path& target)
      : path_(target.string() + "." + std::to_string(system::process()) + ".tmp") {}
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  const fs::path& path() const { return path_; }

private:
  fs::path path_;
};

void require_folder(const fs::path& target) {
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError(folder.string(), 0, 0, "no such folder; make it first");
  }
}

void add_bounds(VolumeFrame& frame, const openvdb::GridBase& grid) {
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty() || grid.activeVoxelCount() <= frame.active_voxels) {
    return;
  }
  frame.active_voxels = grid.activeVoxelCount();
  const openvdb::Vec3d low = grid.indexToWorld(box.min().asVec3d() - openvdb::Vec3d(0.5));
  const openvdb::Vec3d high = grid.indexToWorld(box.max().asVec3d() + openvdb::Vec3d(0.5));
  frame.bounds = {low[0], low[1], low[2], high[0], high[1], high[2]};
}

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

VolumeFrame write_grids(const std::string& path, const openvdb::GridPtrVec& grids,
                        const Metadata& metadata) {
  const fs::path target(path);
  require_folder(target);
  const Temporary temporary(target);
  openvdb::MetaMap file_metadata;
  for (const auto& [key, value] : metadata) {
    file_metadata.insertMeta(key, openvdb::StringMetadata(value));
  }
  VolumeFrame frame;
  try {
    openvdb::io::File file(temporary.path().string());
    file.setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
    file.write(grids, file_metadata);
    file.close();
    fs::rename(temporary.path(), target);
    frame.bytes = fs::file_size(target);
  } catch (const openvdb::Exception& error) {
    throw InputError(path, 0, 0, std::string("cannot write the volume: ") + error.what());
  } catch (const fs::filesystem_error& error) {
    throw InputError(path, 0, 0, "cannot write the volume: " + error.code().message());
  }
  for (const openvdb::GridBase::Ptr& grid : grids) {
    add_bounds(frame, *grid);
  }
  return frame;
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
  VolumeFrame frame = write_grids(path, grids, metadata);
  frame.mass = mass;
  return frame;
}

} // namespace firetwin
