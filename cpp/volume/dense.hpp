#pragma once

#include "base/vector.hpp"
#include "io/metadata.hpp"
#include "volume/frame.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>

namespace firetwin::volume {

/// A dense array (nx, ny, nz), z running fastest.
struct DenseField {
  std::span<const float> values;
  std::array<std::int32_t, 3> shape;
};

/// Writes dense arrays as sparse fog volumes: voxels within `tolerance` of 0 are left out. The
/// frame's mass is the sum of `density` (kg/m3) over voxels times their volume, where there is such
/// a grid.
/// @throws std::invalid_argument for values that are not finite or too large for half precision
Frame write_dense(const std::filesystem::path& path,
                  const std::map<std::string, DenseField>& fields, double voxel_size,
                  const Vector& origin, bool half, float tolerance, const io::Metadata& metadata);

} // namespace firetwin::volume
