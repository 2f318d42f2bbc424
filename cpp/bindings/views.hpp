#pragma once

#include "arrays.hpp"
#include "broadcast.hpp"
#include "lod/frustum.hpp"

#include <algorithm>
#include <vector>

namespace firetwin::bindings {

/// Cameras (m, 3), and rotations (m, 3, 3) and whole angles of view (m, 2) that broadcast to them.
inline std::vector<lod::View> views(const pybind11::object& camera,
                                    const pybind11::object& rotation, const pybind11::object& fov) {
  const auto cameras = to_array<double>(camera, "camera", {-1, 3});
  const pybind11::ssize_t m = cameras.shape(0);
  const auto rotations = spread<double>(rotation, "rotation", {m, 3, 3});
  const auto angles = spread<double>(fov, "fov", {m, 2});
  std::vector<lod::View> result(static_cast<std::size_t>(m));
  for (std::size_t i = 0; i < result.size(); ++i) {
    std::copy_n(cameras.data() + 3 * i, 3, result[i].position.begin());
    std::copy_n(rotations.data() + 9 * i, 9, result[i].to_world.begin());
    result[i].width = angles.data()[2 * i];
    result[i].height = angles.data()[2 * i + 1];
  }
  return result;
}

} // namespace firetwin::bindings
