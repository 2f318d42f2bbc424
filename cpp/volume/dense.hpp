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

/// Dense array (nx, ny, nz), z fastest.
struct DenseField {
  std::span<const float> values;
  std::array<std::int32_t, 3> shape;
};

struct DenseSettings {
  double voxel_size = 1.0; ///< m
  Vector origin{};         ///< centre of voxel (0, 0, 0), m
  bool half = true;        ///< half precision
  float tolerance = 0.0F;  ///< values up to this magnitude are not active
  const lod::ViewSet* view_set =
      nullptr;        ///< leaves that it does not see are culled, see LeafCulling
  std::string within; ///< name of a field: its empty leaves are left out of all others; "":
                      ///< no such field
};

/// Writes dense arrays as sparse fog volumes. Each grid has its own active voxels: the values
/// beyond the tolerance. Constant leaves become tiles. VdbSummary::mass is the integral of the grid
/// `density` (kg/m3), if there is one, and `culled_mass` its integral over the culled leaves.
/// @throws std::invalid_argument if no field is named `within`, or if a value is not finite or too
/// large for half precision
VdbSummary write_dense(const std::filesystem::path& path,
                       const std::map<std::string, DenseField>& fields,
                       const DenseSettings& settings, const io::Metadata& metadata);

} // namespace firetwin::volume
