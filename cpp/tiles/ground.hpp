#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::tiles {

/// Criteria for objects on the ground (tuned on a synthetic scene).
struct GroundOptions {
  double step = 1.0;           ///< m between points
  double max_width = 60.0;     ///< m, width of the widest object
  double min_height = 1.0;     ///< m, height of the lowest object
  double max_threshold = 4.0;  ///< m, upper bound of the height threshold for wide windows
  double slope = 0.15;         ///< slope of the ground relative to the reference surface
  double min_side_slope = 0.7; ///< mean slope of an object's sides; gentler ones are terrain
  double max_roof_bend = 0.25; ///< second difference of a roof, in steps; crowns are rougher
  double max_roof_slope = 1.0; ///< slope of a roof; crowns are steeper
};

/// Class of the highest surface at a point.
enum class SurfaceClass : std::uint8_t { ground, vegetation, building };

/// Ground below objects.
struct Ground {
  std::vector<float> height;               ///< rows x columns, m; NaN where the surface is NaN
  std::vector<SurfaceClass> surface_class; ///< of each point
};

/// Extracts the ground from a surface model (rows x columns, m; NaN for gaps) by a progressive
/// morphological filter: points that an opening with a growing window lowers by more than a
/// threshold belong to objects (Zhang et al. 2003, IEEE Transactions on Geoscience and Remote
/// Sensing 41(4), equations 4 to 7). Three rules are added: low points next to an object belong to
/// it; an object has steep sides, so that sharp ridges stay ground; heights below objects are
/// interpolated linearly between the ground on their sides. Objects with a smooth surface are
/// buildings. @throws std::invalid_argument
Ground find_ground(std::span<const float> height, std::size_t rows, std::size_t columns,
                   const GroundOptions& options);

} // namespace firetwin::tiles
