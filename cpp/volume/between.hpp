#pragma once

#include "base/vector.hpp"
#include "volume/brick.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace firetwin::volume {

/// Values of a brick at the voxels of a finer one: linear between voxels' middles, constant
/// outside, the same numbers as `sample` gives. What depends on one axis alone is found once.
class Between {
public:
  static constexpr std::int64_t lanes = 16;

  /// @param shape of the finer one
  /// @param shift m, by which its places are moved
  Between(const OwnBrick& values, const std::array<std::int64_t, 3>& shape, double voxel,
          const Vector& origin, const Vector& shift);

  /// At so many voxels as there are lanes, one after the other along z; of those beyond the brick
  /// they are as at its last.
  void row(std::int64_t x, std::int64_t y, std::int64_t z, float* out) const;

private:
  /// Neighbours along an axis, and the weight of the higher.
  struct Axis {
    std::vector<std::int32_t> low, high;
    std::vector<float> part;
  };

  const float* values_;
  std::array<std::int64_t, 3> shape_; ///< of the values
  std::array<Axis, 3> axes_;
};

} // namespace firetwin::volume
