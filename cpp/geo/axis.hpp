#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::geo {

/// The two grid values that bracket a place, and where between them it lies.
struct Bracket {
  std::size_t lower;
  std::size_t upper;
  double fraction; ///< 0 at lower, 1 at upper
};

/// Brackets `value` on a strictly ascending or descending axis; places outside it are moved to its
/// nearest end. A NaN gives a NaN fraction.
Bracket bracket(std::span<const double> axis, double value);

/// The value on the axis that is nearest to each of the places.
std::vector<std::size_t> nearest(std::span<const double> axis, std::span<const double> places);

/// Where a cell ends; its value need not lie in the middle when the axis is uneven.
struct Extent {
  double first;
  double last;
};

/// A cell reaches half way to its neighbours; the outermost cells are as wide outwards as inwards.
/// The only cell of an axis has no width.
Extent cell_extent(std::span<const double> axis, std::size_t index);

/// Bilinear interpolation of values[rows x columns] between the corners (y, x), for fields with
/// missing values (firetwin::bilinear gives NaN beside one): corners that are NaN are left out, and
/// the others' weights grow; where the nearest corner is NaN the result is NaN.
double bilinear(std::span<const float> values, std::size_t columns, const Bracket& y,
                const Bracket& x);
double bilinear(std::span<const double> values, std::size_t columns, const Bracket& y,
                const Bracket& x);

/// values on (from_y, from_x) -> bilinear values at (to_y, to_x), row-major.
std::vector<float> resample(std::span<const float> values, std::span<const double> from_y,
                            std::span<const double> from_x, std::span<const double> to_y,
                            std::span<const double> to_x);

} // namespace firetwin::geo
