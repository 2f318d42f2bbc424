#include "volume/fog.hpp"

#include <mutex>

namespace firetwin::volume {

openvdb::FloatGrid::Ptr fog_grid(const std::string& name, double voxel_size, const Vector& origin,
                                 const std::string& units) {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
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

} // namespace firetwin::volume
