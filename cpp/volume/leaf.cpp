#include "volume/leaf.hpp"

#include "base/error.hpp"

#include <string>

namespace firetwin::volume {
namespace {

constexpr std::uint64_t most_leaves = 100'000'000;

} // namespace

openvdb::Coord first_voxel(const openvdb::Coord& place) {
  constexpr auto side = static_cast<openvdb::Int32>(leaf_side);
  return {place.x() * side, place.y() * side, place.z() * side};
}

std::array<float, 3> corner_of(const openvdb::Coord& origin, float voxel_size) {
  return {static_cast<float>(origin.x()) * voxel_size, static_cast<float>(origin.y()) * voxel_size,
          static_cast<float>(origin.z()) * voxel_size};
}

double mass_of(const LeafMask& mask, const LeafValues& values, double voxel_size) {
  double sum = 0.0;
  for (auto voxel = mask.beginOn(); voxel; ++voxel) {
    sum += static_cast<double>(values[voxel.pos()]);
  }
  return sum * voxel_size * voxel_size * voxel_size;
}

void check_leaf_count(std::uint64_t count, double voxel_size) {
  if (count > most_leaves) {
    throw Error("voxels of " + std::to_string(voxel_size) +
                " m are too small for smoke this wide; use larger ones");
  }
}

} // namespace firetwin::volume
