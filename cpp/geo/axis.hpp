#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::geo {

/// The two axis values that bracket a point, and its position between them.
struct Bracket {
  std::size_t lower;
  std::size_t upper;
  double fraction; ///< 0 at lower, 1 at upper
};

/// Brackets `value` on a strictly ascending or descending axis; points outside are clamped to its
/// ends. A NaN gives a NaN fraction.
Bracket bracket(std::span<const double> axis, double value);

/// Index of the nearest axis value for each point.
std::vector<std::size_t> nearest(std::span<const double> axis, std::span<const double> places);

/// Bounds of a cell. Its value need not be in the middle on an irregular axis.
struct Extent {
  double first;
  double last;
};

/// Bounds of a cell: half-way to its neighbours; the outermost cells are symmetric. A single cell
/// has no width.
Extent cell_extent(std::span<const double> axis, std::size_t index);

/// Bilinear interpolation of values[rows x columns] with missing values: NaN corners are skipped
/// and the other weights are renormalized; the result is NaN if the nearest corner is NaN.
/// (firetwin::bilinear returns NaN if any corner is NaN.)
double bilinear(std::span<const float> values, std::size_t columns, const Bracket& y,
                const Bracket& x);
double bilinear(std::span<const double> values, std::size_t columns, const Bracket& y,
                const Bracket& x);

/// Resamples values from the grid (from_y, from_x) to (to_y, to_x) bilinearly; row-major.
std::vector<float> resample(std::span<const float> values, std::span<const double> from_y,
                            std::span<const double> from_x, std::span<const double> to_y,
                            std::span<const double> to_x);

} // namespace firetwin::geo
