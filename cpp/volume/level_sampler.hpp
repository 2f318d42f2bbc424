#pragma once

#include "geo/axis.hpp"
#include "volume/levels.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace firetwin::volume {

/// Reads fields at any place. Keeps where it found the last one, for neighbours lie near.
class LevelSampler {
public:
  using Place = std::array<double, 3>; ///< latitude, longitude, height

  explicit LevelSampler(const Levels& levels)
      : levels_(levels), columns_(levels.longitude.size()),
        plane_(levels.latitude.size() * levels.longitude.size()) {}

  /// Moves to a place; false where there is no smoke to be found.
  bool move(const Place& place) {
    if (!inside(levels_.latitude, place[0]) || !inside(levels_.longitude, place[1])) {
      return false;
    }
    const geo::Bracket row = geo::bracket(levels_.latitude, place[0]);
    const geo::Bracket column = geo::bracket(levels_.longitude, place[1]);
    cells_ = {row.lower * columns_ + column.lower, row.lower * columns_ + column.upper,
              row.upper * columns_ + column.lower, row.upper * columns_ + column.upper};
    weights_ = {(1.0 - row.fraction) * (1.0 - column.fraction),
                (1.0 - row.fraction) * column.fraction, row.fraction * (1.0 - column.fraction),
                row.fraction * column.fraction};
    return find_level(place[2]);
  }

  double value(std::span<const float> field) const {
    const double low = level_value(field, level_);
    return low + part_ * (level_value(field, level_ + 1) - low);
  }

private:
  static bool inside(std::span<const double> axis, double value) {
    return value >= std::min(axis.front(), axis.back()) &&
           value <= std::max(axis.front(), axis.back());
  }

  double level_value(std::span<const float> field, std::size_t level) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      sum += weights_[i] * static_cast<double>(field[level * plane_ + cells_[i]]);
    }
    return sum;
  }

  bool find_level(double height) {
    while (level_ > 0 && height < level_value(levels_.height, level_)) {
      --level_;
    }
    while (level_ + 2 < levels_.levels && height >= level_value(levels_.height, level_ + 1)) {
      ++level_;
    }
    const double low = level_value(levels_.height, level_);
    const double high = level_value(levels_.height, level_ + 1);
    if (height > high || height < level_value(levels_.ground, 0)) {
      return false;
    }
    part_ = height < low ? 0.0 : (height - low) / (high - low);
    return true;
  }

  const Levels& levels_;
  std::size_t columns_;
  std::size_t plane_;
  std::array<std::size_t, 4> cells_{};
  std::array<double, 4> weights_{};
  std::size_t level_ = 0;
  double part_ = 0.0;
};

} // namespace firetwin::volume
