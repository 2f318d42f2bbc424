#pragma once

#include "volume/brick.hpp"

#include <span>

namespace firetwin::volume {

/// Where smoke is seen from.
struct Eyes {
  std::span<const double> places;     ///< (n, 3) m, where lines of sight meet
  std::span<const double> directions; ///< (m, 3) unit vectors towards cameras of parallel ones
};

/// Which smoke no eye sees since it is behind an optical depth of more than `depth` from each: 1 in
/// its voxels; elsewhere values stay.
///
/// The depth is found on voxels of four times the size, linear between: lines of sight are marched,
/// a step for each of these, through this brick and the one beyond it. Without eyes nothing is
/// hidden.
///
/// @param beyond what is returned for a larger brick that is drawn as well; may be null
/// @returns the smoke that hides, 1/m, on voxels of four times the size
/// @throws std::invalid_argument
OwnBrick hidden(const Brick& extinction, const Eyes& eyes, double depth, const Brick* beyond,
                std::span<float> out);

} // namespace firetwin::volume
