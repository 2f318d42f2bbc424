#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::tiles {

/// What counts as an object on the ground (chosen by the errors of a made scene).
struct GroundOptions {
  double step = 1.0;           ///< m between points
  double max_width = 60.0;     ///< m, width of the widest object
  double min_height = 1.0;     ///< m, height of the lowest object
  double max_threshold = 4.0;  ///< m, height from which a wide object is no hill
  double slope = 0.15;         ///< slope of the ground beside what is known of it
  double min_side_slope = 0.7; ///< slope of an object's sides, on average; gentler ones are natural
  double max_roof_bend = 0.25; ///< bend of a roof per point, in steps; crowns are rougher
  double max_roof_slope = 1.0; ///< slope of a roof; crowns are steeper
};

/// What a point shows.
enum class SurfaceClass : std::uint8_t { ground, vegetation, building };

/// Ground below what stands on it.
struct Ground {
  std::vector<float> height;               ///< rows x columns, m; NaN where the highest surface is
  std::vector<SurfaceClass> surface_class; ///< of each point
};

/// Ground of a highest surface (rows x columns, m; NaN without), by a progressive morphological
/// filter: openings by growing windows, and what one lowers by more than a threshold is an object
/// (Zhang et al. 2003, IEEE Transactions on Geoscience and Remote Sensing 41(4), equations 4 to 7).
/// Three things are added: what stands low beside an object belongs to it; an object has steep
/// sides, so that sharp ridges stay; and heights below objects are linear between the ground on
/// their sides. Buildings are objects with an even surface. @throws std::invalid_argument
Ground find_ground(std::span<const float> height, std::size_t rows, std::size_t columns,
                   const GroundOptions& options);

} // namespace firetwin::tiles
