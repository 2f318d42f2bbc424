#pragma once

#include "base/vector.hpp"
#include "volume/voxel_grid.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace firetwin::volume {

/// Trilinear resampling of a voxel grid to a finer one, constant outside; equal to `sample` bit for
/// bit. The weights of each axis are precomputed.
class GridResampler {
public:
  static constexpr std::int64_t lanes = 16;

  /// @param shape shape of the finer grid
  /// @param shift translation of the finer grid's voxels, m
  GridResampler(const OwnedVoxelGrid& values, const std::array<std::int64_t, 3>& shape,
                double voxel, const Vector& origin, const Vector& shift);

  /// Interpolates `lanes` consecutive voxels along z; beyond the grid the last value is repeated.
  void row(std::int64_t x, std::int64_t y, std::int64_t z, float* out) const;

private:
  /// Neighbours along an axis, and the weight of the upper one.
  struct Axis {
    std::vector<std::int32_t> low, high;
    std::vector<float> part;
  };

  const float* values_;
  std::array<std::int64_t, 3> shape_; ///< of the coarse values
  std::array<Axis, 3> axes_;
};

} // namespace firetwin::volume
