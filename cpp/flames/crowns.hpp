#pragma once

#include "base/vector.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::flames {

/// Length of a solved flame, to where half of the time gas burns, over the length up to which it is
/// seen (measured on pictures of opaque flames, see tests/unit/fire/test_flames.py).
constexpr float burning_over_seen = 1.3F;

/// Wind that carries the gas of flames, and how fast it rises.
struct FlameShape {
  std::array<double, 2> wind{}; ///< m/s east and north
  double launch = 1.5;          ///< speed of rise at the ground, m/s
  double acceleration = 7.0;    ///< of rising gas, m/s2

  /// Returns the time that gas takes to rise to a height (m) from the ground, s.
  float flight_to(float height) const;
};

/// A crown in flames: branches from `base` over its foot, flames up to `top`, radius of the crown.
struct Spindle {
  float x, y, z, base, top, radius; ///< m
};

/// Crowns in flames, listed by cells of the ground.
class FlameCrowns {
public:
  static constexpr float upright = 0.4F; ///< part of `top` up to which flames stand upright
  static constexpr float lean = 0.5F;    ///< of them above, relative to free gas

  /// @param tall, wide height of a crown's block over `top`, and half its width over its size
  /// @param origin coordinates of lookups are relative to it, m
  FlameCrowns(std::span<const Spindle> crowns, const FlameShape& shape, float tall, float wide,
              const Vector& origin);

  /// Returns the length by which a crown's block is scaled across, m.
  static float size(const Spindle& crown);

  bool empty() const { return crowns_.empty(); }
  std::span<const Spindle> all() const { return crowns_; }
  /// Hash of a crown's place.
  std::uint32_t hash(std::size_t number) const { return hashes_[number]; }
  /// Rectangle that a crown's flames may reach: x from, x to, y from, y to.
  const std::array<float, 4>& box(std::size_t number) const { return boxes_[number]; }
  /// Height of the top of a crown's flames, m.
  float top(const Spindle& crown) const { return crown.z + tall_ * crown.top; }

  /// Numbers of the crowns whose flames may reach a place.
  std::span<const std::uint32_t> at(float x, float y) const;
  /// Returns a distance (m) along a ray without flames of crowns; 0 near them.
  /// @param across cosine of the ray's elevation
  float free_distance(float x, float y, float z, float across) const;

private:
  std::vector<Spindle> crowns_;
  std::vector<std::uint32_t> hashes_;
  std::vector<std::array<float, 4>> boxes_;
  std::vector<std::uint32_t> starts_, numbers_; // by cell
  std::array<float, 2> corner_{};
  std::array<std::int64_t, 2> cells_{};
  float tall_;
};

} // namespace firetwin::flames
