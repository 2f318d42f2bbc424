#pragma once

#include "base/vector.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::volume {

/// Values (nx, ny, nz) in the middles of cubic voxels, z running fastest.
struct Brick {
  std::span<const float> values;
  std::array<std::int64_t, 3> shape;
  double voxel;  ///< m
  Vector origin; ///< centre of the first voxel, m
};

/// The same with values of its own.
struct OwnBrick {
  std::vector<float> values;
  std::array<std::int64_t, 3> shape;
  double voxel;
  Vector origin;

  Brick view() const { return {values, shape, voxel, origin}; }
};

/// @throws std::invalid_argument unless there are as many values as voxels, and they have a size
void check(const Brick& brick);

/// Linear between voxels' middles, constant outside.
float sample(const Brick& brick, const Vector& place);

/// Which voxels have smoke in them or in one of the 26 around: 1 or 0.
std::vector<std::uint8_t> near_smoke(const Brick& smoke);

/// The same smoke in voxels of twice the size; what lies beyond the brick is clear.
OwnBrick halved(const Brick& smoke);

} // namespace firetwin::volume
