#pragma once

#include "base/vector.hpp"
#include "terrain/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::terrain {

/// Points of a mesh: a lattice of 2^depth units per cell.
class Points {
public:
  Points(const MeshInput& input, const NearDetail& detail);

  int depth() const { return depth_; }
  std::int32_t width() const { return width_; }   ///< units
  std::int32_t height() const { return height_; } ///< units

  /// Position of a lattice point on the ground.
  /// @param waves from `waves()`
  Vector at(std::int32_t x, std::int32_t y, std::span<Wave> waves) const;
  std::vector<Wave> waves() const;

  /// Calls `visit(place, tolerance)` for all relevant points with x and y in these inclusive ranges
  /// of units until it returns false. @return true if no call returned false
  template <class Visit>
  bool each(std::int32_t left, std::int32_t right, std::int32_t low, std::int32_t high,
            const Visit& visit) const;

private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  Vector between(std::size_t row, std::size_t column, double v, double u) const;
  double weight(const Vector& place) const;
  void raise_nodes();
  void fill_tiles();
  double min_tolerance(std::size_t row, std::size_t column) const;
  template <class Visit>
  bool tile(std::size_t row, std::size_t column, std::int32_t left, std::int32_t right,
            std::int32_t low, std::int32_t high, const Visit& visit) const;

  MeshInput input_;
  NearDetail detail_;
  int depth_ = 0;
  std::int32_t width_, height_;
  double box_[4] = {};        ///< bounds around all cameras: min x, max x, min y, max y
  std::vector<float> raised_; ///< node heights relative to the input; empty: no detail
  std::vector<std::uint32_t>
      offset_; ///< start of each cell's heights in `tiles_`; empty: no subdivided cell
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
      const std::size_t i = row * input_.columns + column;
      const float* p = &input_.place[3 * i];
      const double z = double{p[2]} + (raised_.empty() ? 0.0 : double{raised_[i]});
      if (!visit(Vector{p[0], p[1], z}, double{input_.tolerance[i]})) {
        return false;
      }
    }
  }
  if (offset_.empty()) {
    return true;
  }
  const std::size_t last_row = std::min(down(high), input_.rows - 2);
  const std::size_t last_column = std::min(down(right), input_.columns - 2);
  for (std::size_t row = down(low); row <= last_row; ++row) {
    for (std::size_t column = down(left); column <= last_column; ++column) {
      if (input_.subdivision[row * (input_.columns - 1) + column] > 0 &&
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
  const std::size_t cell = row * (input_.columns - 1) + column;
  const int level = input_.subdivision[cell];
  const std::int32_t count = std::int32_t{1} << level, step = std::int32_t{1} << (depth_ - level);
  const std::int32_t x0 = static_cast<std::int32_t>(column) << depth_;
  const std::int32_t y0 = static_cast<std::int32_t>(row) << depth_;
  const auto first = [&](std::int32_t from) { return from <= 0 ? 0 : (from + step - 1) / step; };
  const auto last = [&](std::int32_t to) { return std::min(to / step, count); };
  const float* height = &tiles_[offset_[cell]];
  const double tolerance = min_tolerance(row, column), part = 1.0 / count;
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
