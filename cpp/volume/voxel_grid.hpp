#pragma once

#include "base/vector.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::volume {

/// Dense voxel grid: values (nx, ny, nz) at the centres of cubic voxels, z fastest (a view).
struct VoxelGrid {
  std::span<const float> values;
  std::array<std::int64_t, 3> shape;
  double voxel;  ///< m
  Vector origin; ///< centre of the first voxel, m
};

/// A dense voxel grid that owns its values.
struct OwnedVoxelGrid {
  std::vector<float> values;
  std::array<std::int64_t, 3> shape;
  double voxel;
  Vector origin;

  VoxelGrid view() const { return {values, shape, voxel, origin}; }
};

/// @throws std::invalid_argument unless there are as many values as voxels, and they have a size
void check(const VoxelGrid& brick);

/// Trilinear interpolation, constant outside: a sum of weighted voxels, as GridResampler has it.
float sample(const VoxelGrid& brick, const Vector& place);

/// Mask of voxels with smoke in them or in one of their 26 neighbours: 1 or 0.
std::vector<std::uint8_t> near_smoke(const VoxelGrid& smoke);

/// Coarsening to voxels of twice the size; smoke beyond the grid is clear.
OwnedVoxelGrid halved(const VoxelGrid& smoke);

} // namespace firetwin::volume
