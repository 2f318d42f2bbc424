#pragma once

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace firetwin {

using Metadata = std::map<std::string, std::string>;

/// What one VDB file holds.
struct VolumeFrame {
  std::uint64_t active_voxels = 0; // of the grid with the most
  std::uint64_t voxels = 0;        // active ones of all grids
  std::uint64_t bytes = 0;
  std::array<double, 6> bounds{}; // m: lowest corner, highest corner; zeros when empty
  double mass = 0.0;              // kg of smoke
  double hidden = 0.0;            // kg left out since no camera sees it
};

/// A dense array (nx, ny, nz), z running fastest.
struct DenseField {
  std::span<const float> values;
  std::array<std::int32_t, 3> shape;
};

/// An empty fog volume of cubic voxels; voxel (0, 0, 0) is centred on `origin`.
openvdb::FloatGrid::Ptr fog_grid(const std::string& name, double voxel_size,
                                 const std::array<double, 3>& origin, const std::string& units);

/// Writes dense arrays as sparse fog volumes: voxels within `tolerance` of 0 are left out.
/// `mass` is the sum of `density` (kg/m3) over voxels times their volume, where there is such a
/// grid.
VolumeFrame write_dense(const std::string& path, const std::map<std::string, DenseField>& fields,
                        double voxel_size, const std::array<double, 3>& origin, bool half,
                        float tolerance, const Metadata& metadata);

} // namespace firetwin
