#pragma once

#include "base/vector.hpp"
#include "io/metadata.hpp"
#include "lod/view_set.hpp"
#include "volume/vdb_summary.hpp"

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

struct DenseSettings {
  double voxel_size = 1.0; ///< m
  Vector origin{};         ///< centre of voxel (0, 0, 0), m
  bool half = true;        ///< precision
  float tolerance = 0.0F;  ///< values this near 0 are left out
  const lod::ViewSet* view_set =
      nullptr;        ///< leaves that do not count are left out, see LeafCulling
  std::string within; ///< the field without whose leaves others have none; none: ""
};

/// Writes dense arrays as sparse fog volumes, each with its own active voxels: those beyond the
/// tolerance. Leaves of one value become tiles. The frame's mass is the sum of `density` (kg/m3)
/// over voxels times their volume, where there is such a grid, and `culled_mass` that of what is
/// left out because it is not seen.
/// @throws std::invalid_argument when there is no field called `within`, and for values that are
/// not finite or too large for half precision
VdbSummary write_dense(const std::filesystem::path& path,
                       const std::map<std::string, DenseField>& fields,
                       const DenseSettings& settings, const io::Metadata& metadata);

} // namespace firetwin::volume
