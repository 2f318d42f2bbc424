#pragma once

#include <array>
#include <cstdint>

namespace firetwin::volume {

/// What one VDB file holds.
struct Frame {
  std::uint64_t active_voxels = 0; ///< of the grid with the most
  std::uint64_t voxels = 0;        ///< active ones of all grids
  std::uint64_t bytes = 0;
  std::array<double, 6> bounds{}; ///< m: lowest corner, highest corner; zeros when empty
  double mass = 0.0;              ///< kg of smoke
  double hidden = 0.0;            ///< kg left out since no camera sees it
};

} // namespace firetwin::volume
