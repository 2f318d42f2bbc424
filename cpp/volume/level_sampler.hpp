#pragma once

#include "base/interpolation.hpp"
#include "geo/axis.hpp"
#include "volume/levels.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace firetwin::volume {

/// Interval search along a strictly monotonic axis; each search starts at the previous result.
class AxisFollower {
public:
  explicit AxisFollower(std::span<const double> axis)
      : axis_(axis), ascending_(axis.front() < axis.back()) {}

  /// Moves to a value; false if it is outside the axis.
  bool move(double value) {
    if (before(value, axis_.front()) || before(axis_.back(), value)) {
      return false;
    }
    if (!placed_) {
      interval_ = geo::bracket(axis_, value).lower;
      placed_ = true;
    }
    while (interval_ > 0 && before(value, axis_[interval_])) {
      --interval_;
    }
    while (interval_ + 2 < axis_.size() && !before(value, axis_[interval_ + 1])) {
      ++interval_;
    }
    fraction_ = (value - axis_[interval_]) / (axis_[interval_ + 1] - axis_[interval_]);
    return true;
  }

  std::size_t interval() const { return interval_; }
  double fraction() const { return fraction_; } ///< within the interval, 0 to 1

private:
  bool before(double a, double b) const { return ascending_ ? a < b : a > b; }

  std::span<const double> axis_;
  bool ascending_;
  bool placed_ = false;
  std::size_t interval_ = 0;
  double fraction_ = 0.0;
};

/// Interpolates fields at arbitrary positions. The search starts at the previous position, since
/// consecutive positions are close together.
class LevelSampler {
public:
  using Place = std::array<double, 3>; ///< latitude, longitude, height

  explicit LevelSampler(const Levels& levels)
      : levels_(levels), row_(levels.latitude), column_(levels.longitude),
        columns_(levels.longitude.size()), plane_(levels.latitude.size() * columns_) {}

  /// Moves to a position; false if there is no smoke data.
  bool move(const Place& place) {
    if (!row_.move(place[0]) || !column_.move(place[1])) {
      return false;
    }
    const std::size_t cell = row_.interval() * columns_ + column_.interval();
    cells_ = {cell, cell + 1, cell + columns_, cell + columns_ + 1};
    const double north = row_.fraction();
    const double east = column_.fraction();
    weights_ = bilinear_weights(north, east);
    return find_level(place[2]);
  }

  /// Returns the smoke at the current position, kg/m3.
  double smoke() const {
    return between([&](std::size_t i) { return valid_smoke(levels_.smoke[i]); });
  }
  double temperature() const { ///< K
    return between([&](std::size_t i) { return levels_.temperature[i]; });
  }

private:
  /// Interpolates linearly between the levels below and above.
  template <class Field> double between(const Field& field) const {
    return lerp(on_level(field, level_), on_level(field, level_ + 1), part_);
  }

  template <class Field> double on_level(const Field& field, std::size_t level) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      sum += weights_[i] * static_cast<double>(field(level * plane_ + cells_[i]));
    }
    return sum;
  }

  double height(std::size_t level) const {
    return on_level([&](std::size_t i) { return levels_.height[i]; }, level);
  }

  bool find_level(double place) {
    double low = height(level_);
    double high = height(level_ + 1);
    while (level_ > 0 && place < low) {
      high = low;
      low = height(--level_);
    }
    while (level_ + 2 < levels_.levels && place >= high) {
      low = high;
      high = height(++level_ + 1);
    }
    if (place > high || place < on_level([&](std::size_t i) { return levels_.ground[i]; }, 0)) {
      return false;
    }
    part_ = place < low ? 0.0 : (place - low) / (high - low);
    return true;
  }

  const Levels& levels_;
  AxisFollower row_;
  AxisFollower column_;
  std::size_t columns_;
  std::size_t plane_;
  std::array<std::size_t, 4> cells_{};
  std::array<double, 4> weights_{};
  std::size_t level_ = 0;
  double part_ = 0.0;
};

} // namespace firetwin::volume
