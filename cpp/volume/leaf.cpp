#include "volume/leaf.hpp"

#include "base/check.hpp"
#include "base/error.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace firetwin::volume {
namespace {

constexpr double smallest_voxel = 1.0e-4; // m; OpenVDB treats far smaller voxels as singular
constexpr double largest_voxel = 1.0e6;   // m; far below overflow of a voxel's volume in float
constexpr double most_leaves = 1.0e8;
constexpr double farthest_leaf =
    1 << 27; // the voxel index, eight times as large, must fit into 32 bits

[[noreturn]] void too_small(double voxel_size) {
  std::ostringstream text;
  text << "voxels of " << voxel_size
       << " m are too small for smoke of this extent; use larger voxels";
  throw Error(text.str());
}

} // namespace

Coord first_voxel(const Coord& place) {
  constexpr auto side = static_cast<std::int32_t>(leaf_side);
  return {place.x() * side, place.y() * side, place.z() * side};
}

std::array<float, 3> corner_of(const Coord& origin, float voxel_size) {
  return {static_cast<float>(origin.x()) * voxel_size, static_cast<float>(origin.y()) * voxel_size,
          static_cast<float>(origin.z()) * voxel_size};
}

double mass_of(const LeafMask& mask, const LeafValues& values, double voxel_size) {
  double sum = 0.0;
  mask.each([&](std::size_t voxel) { sum += static_cast<double>(values[voxel]); });
  return sum * voxel_size * voxel_size * voxel_size;
}

void check_voxel_size(double voxel_size) {
  check_above_zero(voxel_size, "voxel_size");
  if (voxel_size < smallest_voxel || voxel_size > largest_voxel) {
    std::ostringstream text;
    text << "voxel_size must be 1e-4 to 1e6 m, not " << voxel_size;
    throw std::invalid_argument(text.str());
  }
}

int leaf_number(double place, double voxel_size) {
  const double number = std::floor(place / (voxel_size * static_cast<double>(leaf_side)));
  if (!(std::abs(number) < farthest_leaf)) {
    too_small(voxel_size);
  }
  return static_cast<int>(number);
}

void check_leaf_count(double count, double voxel_size) {
  if (count > most_leaves) {
    too_small(voxel_size);
  }
}

} // namespace firetwin::volume
