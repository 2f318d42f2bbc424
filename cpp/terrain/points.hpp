#pragma once

#include "base/vector.hpp"
#include "terrain/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::terrain {

/// The points that a mesh is made of and compared with: a lattice of 2^depth units to a cell.
class Points {
public:
  Points(const Survey& survey, const Close& close);

  int depth() const { return depth_; }
  std::int32_t width() const { return width_; }   ///< units
  std::int32_t height() const { return height_; } ///< units

  /// Place of a point of the lattice, which lies on the ground.
  /// @param waves the surface's, as `waves` gives them
  Vector at(std::int32_t x, std::int32_t y, std::span<Wave> waves) const;
  std::vector<Wave> waves() const;

  /// Calls `visit(place, tolerance)` for every point that counts with x and y between these units,
  /// both inclusive, and stops when it returns false. @return whether none did
  template <class Visit>
  bool each(std::int32_t left, std::int32_t right, std::int32_t low, std::int32_t high,
            const Visit& visit) const;

private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  Vector between(std::size_t row, std::size_t column, double v, double u) const;
  double weight(const Vector& place) const;
  void raise_nodes();
  void fill_tiles();
  double least_tolerance(std::size_t row, std::size_t column) const;
  template <class Visit>
  bool tile(std::size_t row, std::size_t column, std::int32_t left, std::int32_t right,
            std::int32_t low, std::int32_t high, const Visit& visit) const;

  Survey survey_;
  Close close_;
  int depth_ = 0;
  std::int32_t width_, height_;
  double box_[4] = {};        ///< round all eyes: least x, greatest x, least y, greatest y
  std::vector<float> raised_; ///< height of nodes less that of the survey; empty: none
  std::vector<std::uint32_t>
      offset_; ///< of each cell's heights in `tiles_`; empty: no cell is fine
  std::vector<float> tiles_;
};

template <class Visit>
bool Points::each(std::int32_t left, std::int32_t right, std::int32_t low, std::int32_t high,
                  const Visit& visit) const {
  const std::int32_t unit = std::int32_t{1} << depth_;
  const auto up = [&](std::int32_t value) {
    return static_cast<std::size_t>((value + unit - 1) >> depth_);
  };
  const auto down = [&](std::int32_t value) { return static_cast<std::size_t>(value >> depth_); };
  for (std::size_t row = up(low); row <= down(high); ++row) {
    for (std::size_t column = up(left); column <= down(right); ++column) {
      const std::size_t i = row * survey_.columns + column;
      const float* p = &survey_.place[3 * i];
      const double z = double{p[2]} + (raised_.empty() ? 0.0 : double{raised_[i]});
      if (!visit(Vector{p[0], p[1], z}, double{survey_.tolerance[i]})) {
        return false;
      }
    }
  }
  if (offset_.empty()) {
    return true;
  }
  const std::size_t last_row = std::min(down(high), survey_.rows - 2);
  const std::size_t last_column = std::min(down(right), survey_.columns - 2);
  for (std::size_t row = down(low); row <= last_row; ++row) {
    for (std::size_t column = down(left); column <= last_column; ++column) {
      if (survey_.fine[row * (survey_.columns - 1) + column] > 0 &&
          !tile(row, column, left, right, low, high, visit)) {
        return false;
      }
    }
  }
  return true;
}

template <class Visit>
bool Points::tile(std::size_t row, std::size_t column, std::int32_t left, std::int32_t right,
                  std::int32_t low, std::int32_t high, const Visit& visit) const {
  const std::size_t cell = row * (survey_.columns - 1) + column;
  const int level = survey_.fine[cell];
  const std::int32_t count = std::int32_t{1} << level, step = std::int32_t{1} << (depth_ - level);
  const std::int32_t x0 = static_cast<std::int32_t>(column) << depth_;
  const std::int32_t y0 = static_cast<std::int32_t>(row) << depth_;
  const auto first = [&](std::int32_t from) { return from <= 0 ? 0 : (from + step - 1) / step; };
  const auto last = [&](std::int32_t to) { return std::min(to / step, count); };
  const float* height = &tiles_[offset_[cell]];
  const double tolerance = least_tolerance(row, column), part = 1.0 / count;
  for (std::int32_t j = first(low - y0); j <= last(high - y0); ++j) {
    for (std::int32_t i = first(left - x0); i <= last(right - x0); ++i) {
      Vector place = between(row, column, j * part, i * part);
      place[2] = double{height[j * (count + 1) + i]};
      if (!visit(place, tolerance)) {
        return false;
      }
    }
  }
  return true;
}

} // namespace firetwin::terrain
