#pragma once

#include "base/vector.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::volume {

/// Dense voxel grid (a view): values (nx, ny, nz) at the centres of cubic voxels, z fastest.
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

/// @throws std::invalid_argument unless there is one value per voxel and a positive voxel size
void check(const VoxelGrid& brick);

/// Interpolates trilinearly, constant outside: a weighted sum of voxels, in the same order as
/// GridResampler.
float sample(const VoxelGrid& brick, const Vector& place);

/// Returns the mask of voxels that have smoke, or a neighbour (of 26) with smoke: 1 or 0.
std::vector<std::uint8_t> near_smoke(const VoxelGrid& smoke);

/// Averages to voxels of twice the size; beyond the grid the air is clear.
OwnedVoxelGrid halved(const VoxelGrid& smoke);

} // namespace firetwin::volume
