#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace firetwin::volume {

/// Index of a voxel or of a leaf; sorted by x, y and z.
class Coord {
public:
  constexpr Coord() = default;
  constexpr Coord(std::int32_t x, std::int32_t y, std::int32_t z) : axes_{x, y, z} {}

  constexpr std::int32_t x() const { return axes_[0]; }
  constexpr std::int32_t y() const { return axes_[1]; }
  constexpr std::int32_t z() const { return axes_[2]; }
  constexpr std::int32_t operator[](std::size_t axis) const { return axes_[axis]; }
  constexpr std::int32_t& operator[](std::size_t axis) { return axes_[axis]; }

  constexpr Coord offset(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return {axes_[0] + x, axes_[1] + y, axes_[2] + z};
  }

  friend constexpr auto operator<=>(const Coord&, const Coord&) = default;

private:
  std::array<std::int32_t, 3> axes_{};
};

/// Box of coordinates that includes both corners; empty at first.
struct CoordBox {
  static constexpr std::int32_t largest = std::numeric_limits<std::int32_t>::max();
  Coord low{largest, largest, largest};
  Coord high{-largest, -largest, -largest};

  bool is_empty() const { return low.x() > high.x(); }

  bool contains(const CoordBox& other) const {
    bool inside = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      inside = inside && low[axis] <= other.low[axis] && high[axis] >= other.high[axis];
    }
    return inside;
  }

  void expand(const Coord& point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], point[axis]);
      high[axis] = std::max(high[axis], point[axis]);
    }
  }

  /// Returns the number of coordinates along an axis.
  std::int32_t size(std::size_t axis) const { return high[axis] - low[axis] + 1; }
};

} // namespace firetwin::volume
