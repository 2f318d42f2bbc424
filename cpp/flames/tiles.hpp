#pragma once

#include "base/simd.hpp"
#include "base/vector.hpp"
#include "flames/crowns.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::flames {

/// Values of a node of the ground.
enum Channel : std::size_t {
  ground_channel,   ///< elevation, m
  length_channel,   ///< length of the front's flames, whatever their age, m
  distance_channel, ///< behind the front, m; negative ahead of it
  low_channel,      ///< height of the flames that burn behind the front, m
  share_channel,    ///< share of the ground here that burns, 0 to 1
  east_channel,     ///< of the direction in which the front moves, a unit vector
  north_channel,
  scale_channel, ///< mean length of the flames around, at least `length_channel`: patterns' size, m
  channel_count
};

static_assert(channel_count == lane_count, "nodes are read as vectors");

using Node = std::array<float, channel_count>;
using NodeLanes = std::array<Lanes, channel_count>;

/// Squares of the ground of `patch_side` cells where something may burn. Finer ones cover coarser
/// ones, and nothing burns outside of all.
struct FlamePatches {
  std::span<const float> nodes;    ///< (n, side + 1, side + 1, channels), rows to the north
  std::span<const double> corner;  ///< (n, 2) x and y of the first node, m
  std::span<const double> spacing; ///< (n) m, powers of 2 of the finest
};
constexpr std::int64_t patch_side = 32; ///< cells

/// How far flames reach from their foot, in drawn lengths.
struct FlameReach {
  float ahead, behind, top;
  float least; ///< drawn length per distance from the origin, m/m
};

/// Patches of the ground, with bounds on how high flames reach over tiles of them.
class FlameTiles {
public:
  static constexpr std::int64_t side = 8; ///< cells along a tile
  static constexpr float none = -1.0e9F;

  /// @param origin coordinates of lookups are relative to it, m
  /// @throws std::invalid_argument
  FlameTiles(const FlamePatches& patches, const FlameShape& shape, const FlameReach& reach,
             const FlameCrowns& crowns, const Vector& origin);

  /// Interpolates the ground at eight places; its elevation is `none` outside of all patches.
  void nodes(const Lanes& x, const Lanes& y, NodeLanes& out) const;
  /// The same, for what varies slowly: the ground, directions, lengths.
  void ends(const Lanes& x, const Lanes& y, NodeLanes& out) const;
  /// Ground at a place, m; `none` outside.
  float ground_at(float x, float y) const;

  /// Flames whose foot may be near a place.
  struct Roots {
    float longest; ///< length of the longest flames, m; 0 where nothing burns
    float edge;    ///< distance within which that holds, m
  };
  Roots rooted(float x, float y) const;

  /// Tile around a place.
  struct Tile {
    float top;                   ///< greatest height of flames, m; `none`: no flames
    float length;                ///< of the longest flames that reach it, m
    std::array<float, 4> bounds; ///< x from, x to, y from, y to
  };
  /// Finds the tile at a place; false outside of all.
  bool find(float x, float y, Tile& tile) const;

  bool empty() const { return !any_; }
  const std::array<float, 4>& bounds() const { return bounds_; }
  std::array<float, 2> heights() const { return heights_; }

private:
  static constexpr std::int64_t tiles_along = patch_side / side;
  static constexpr std::size_t tile_count = tiles_along * tiles_along;
  struct Patch {
    std::vector<Node> nodes;
    float x, y, spacing, inverse;
    std::array<float, tile_count> top, longest; ///< of flames that reach a tile
    std::array<float, tile_count> rooted;       ///< of flames whose foot is in or near a tile

    bool contains(float east, float north) const;
    void interpolate(float east, float north, Lanes& out) const;
    std::size_t tile_at(float east, float north, float& right, float& up) const;
    Tile tile(std::size_t number) const;
  };
  /// Patches of one spacing, by their place.
  struct Level {
    double span;                             ///< m
    std::array<std::int64_t, 2> first, size; ///< in spans: x, y
    std::vector<std::int32_t> index;         ///< -1: none
    /// Covers squares from one to another, all without a number.
    /// @throws std::invalid_argument if there are too many
    void cover(const std::array<std::int64_t, 2>& low, const std::array<std::int64_t, 2>& high);
    void set(std::int64_t i, std::int64_t j, std::int32_t number);
    std::int32_t at(std::int64_t i, std::int64_t j) const;
  };

  void add_patches(const FlamePatches& patches, const Vector& origin);
  void list_levels(const FlamePatches& patches);
  void bound_patches(const FlameShape& shape, const FlameReach& reach);
  void bound_crowns(const FlameCrowns& crowns);
  void list_occupied(const FlameCrowns& crowns);
  const Patch* patch(float x, float y) const;
  std::array<std::int64_t, 2> place(float x, float y, double span) const;
  std::array<float, 4> square(const std::array<std::int64_t, 2>& at, double span) const;
  template <class Function> void visit(const std::array<float, 4>& box, const Function& function);
  void raise(const std::array<float, 4>& box, float top, float length);

  Vector origin_;
  std::vector<Patch> patches_;
  std::vector<Level> levels_;       ///< finest first
  float finest_ = 0.0F;             ///< spacing, m
  std::array<Level, 2> occupied_{}; ///< wide and narrow squares with flames: 0, else -1
  std::array<float, 4> bounds_{};
  std::array<float, 2> heights_{};
  bool any_ = false;
};

} // namespace firetwin::flames
