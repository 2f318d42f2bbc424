#pragma once

#include <array>
#include <cstdint>

namespace firetwin::volume {

/// Summary of one VDB file.
struct VdbSummary {
  std::uint64_t active_voxels = 0; ///< of the grid that has the most
  std::uint64_t voxels = 0;        ///< active voxels of all grids
  std::uint64_t bytes = 0;
  std::array<double, 6> bounds{}; ///< m: lower corner, upper corner; zeros if empty
  double mass = 0.0;              ///< kg of smoke
  double culled_mass = 0.0;       ///< kg of smoke in culled leaves
};

} // namespace firetwin::volume
