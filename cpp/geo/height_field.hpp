#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::geo {

/// Ground heights on a rectilinear grid in local metres, interpolated bilinearly.
class HeightField {
public:
  /// @param x, y strictly ascending or descending, m
  /// @param height [y x] m; values that are not finite mean no ground
  /// @throws std::invalid_argument
  HeightField(std::span<const double> x, std::span<const double> y, std::span<const float> height);

  const std::vector<double>& x() const { return x_; }
  const std::vector<double>& y() const { return y_; }
  double highest() const { return highest_; } ///< -infinity without any ground
  double smallest_cell() const { return smallest_cell_; }

  /// Height at a point; outside the grid, the height of the nearest edge. NaN without ground.
  double at(double x, double y) const;

private:
  std::vector<double> x_, y_;
  std::vector<float> height_; ///< ascending in both axes
  double highest_;
  double smallest_cell_;
};

} // namespace firetwin::geo
