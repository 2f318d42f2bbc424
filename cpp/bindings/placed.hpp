#pragma once

#include "arrays.hpp"
#include "base/vector.hpp"
#include "volume/voxel_grid.hpp"

#include <pybind11/pybind11.h>

#include <optional>
#include <tuple>
#include <utility>

/// Voxel grids as arguments.
namespace firetwin::bindings {

inline volume::VoxelGrid brick(const Array<float>& values, double voxel_size,
                               const Vector& origin) {
  return {view(values), {values.shape(0), values.shape(1), values.shape(2)}, voxel_size, origin};
}

using Placed = std::tuple<pybind11::object, double, Vector>; // values, voxel size, origin

inline pybind11::tuple placed(volume::OwnedVoxelGrid&& brick) {
  const auto [nx, ny, nz] = brick.shape;
  return pybind11::make_tuple(give(std::move(brick.values), {nx, ny, nz}), brick.voxel,
                              brick.origin);
}

/// An optional voxel grid; owns its array.
class Beyond {
public:
  explicit Beyond(const std::optional<Placed>& given) {
    if (given) {
      const auto& [values, voxel_size, origin] = *given;
      values_ = to_array<float>(values, "beyond", {-1, -1, -1});
      brick_ = brick(values_, voxel_size, origin);
    }
  }

  const volume::VoxelGrid* get() const { return brick_ ? &*brick_ : nullptr; }

private:
  Array<float> values_;
  std::optional<volume::VoxelGrid> brick_;
};

} // namespace firetwin::bindings
