#pragma once

#include "base/simd.hpp"
#include "base/vector.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::flames {

/// Flame length at one time, and the ground, on a square of the ground.
struct FlameSquare {
  std::span<const float> length, ground; ///< (rows, columns) m; rows to the north
  std::array<std::int64_t, 2> shape;     ///< rows and columns
  std::array<double, 2> corner;          ///< x and y of the first value, m
  double spacing;                        ///< m
};

/// A crown in flames: branches from `base` over its foot, flames up to `top`, radius of the crown.
struct Spindle {
  float x, y, z, base, top, radius; ///< m
};

/// Nested squares of flame length, fine to coarse, with bounds on how high flames reach over tiles.
class FlameTiles {
public:
  static constexpr std::int64_t side = 8;   ///< cells along a tile
  static constexpr float soot_top = 1.9F;   ///< height to which soot reaches, in flame lengths
  static constexpr float crown_top = 1.3F;  ///< height to which flames of a crown reach, in `top`
  static constexpr float crown_wide = 1.5F; ///< their greatest radius, in radii of the crown
  static constexpr float upright = 0.45F;   ///< part of `top` up to which they stand upright
  static constexpr float lean = 0.8F;       ///< of them above, relative to free flames
  static constexpr float none = -1.0e9F;

  /// @param squares finest first; all are around the camera
  /// @param wind speed at which rising gas is carried, m/s, and the constants of its rise
  /// @param origin coordinates of lookups are relative to it, m
  /// @throws std::invalid_argument
  FlameTiles(std::span<const FlameSquare> squares, std::span<const Spindle> spindles,
             const std::array<double, 2>& wind, double launch, double acceleration,
             const Vector& origin);

  /// Ground at eight places close together, m; `none` outside of all squares.
  void ground(const Lanes& x, const Lanes& y, Lanes& out) const;
  /// Flame length at eight places close together, m; 0 outside.
  void length(const Lanes& x, const Lanes& y, Lanes& out) const;

  /// Ground at a place, m; `none` outside of all squares.
  float ground_at(float x, float y) const;
  /// Flames whose foot may be near a place.
  struct Roots {
    float longest; ///< length of the longest flames within their swing, m; 0 outside of all squares
    float edge;    ///< distance within which that holds, m
  };
  Roots rooted(float x, float y) const;
  /// Returns a distance (m) along a ray without flames of crowns; 0 near them.
  /// @param across cosine of the ray's elevation
  float spindle_distance(float x, float y, float z, float across) const;

  /// Tile around a place.
  struct Tile {
    float top;                   ///< greatest height of flames and soot, m; `none`: no flames
    float length;                ///< of the longest flames that reach it, m
    std::array<float, 4> bounds; ///< x from, x to, y from, y to
  };
  /// Finds the tile at a place; false outside of all squares.
  bool find(float x, float y, Tile& tile) const;

  std::span<const Spindle> spindles() const { return spindles_; }
  /// Numbers of the spindles that reach a place.
  std::span<const std::uint32_t> spindles_at(float x, float y) const;
  bool empty() const { return !any_; }
  const std::array<float, 4>& bounds() const { return bounds_; }
  std::array<float, 2> heights() const { return heights_; }

private:
  struct Level {
    std::vector<float> length, ground; // (rows, columns)
    std::int64_t rows, columns, tile_rows, tile_columns;
    float x, y, spacing, inverse;
    std::array<float, 2> end;        ///< of places inside, m
    std::vector<float> top, longest; ///< of flames that reach a tile, leaning
    std::vector<float> rooted; ///< length of the longest flames whose foot is in or near a tile

    bool contains(float east, float north) const {
      return east >= x && north >= y && east < end[0] && north < end[1];
    }
  };

  const Level* level(float x, float y) const;
  void interpolate_lanes(std::vector<float> Level::* values, float outside, const Lanes& x,
                         const Lanes& y, Lanes& out) const;
  template <class Function>
  void visit(float x0, float x1, float y0, float y1, const Function& function);
  void raise(float x0, float x1, float y0, float y1, float top, float length);
  void add_square(const FlameSquare& square, const Vector& origin);
  void bound_tiles(const std::array<double, 2>& wind, double launch, double acceleration);
  void list_spindles(const std::array<double, 2>& wind, double launch, double acceleration);

  std::vector<Level> levels_;
  std::vector<Spindle> spindles_;
  std::vector<std::uint32_t> starts_, numbers_; // of spindles, by cell of a grid
  std::array<float, 2> spindle_corner_{};
  std::array<std::int64_t, 2> spindle_cells_{};
  std::array<float, 4> bounds_{};
  std::array<float, 2> heights_{};
  bool any_ = false;
};

} // namespace firetwin::flames
