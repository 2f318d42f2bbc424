#pragma once

#include "base/vector.hpp"
#include "flames/crowns.hpp"
#include "flames/library.hpp"
#include "flames/tiles.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace firetwin::flames {

/// Gas of one kind of flames at eight points. The part `fine` of it is a stored mixture fraction,
/// the rest is of coarser levels.
struct GasLanes {
  Lanes code{};         ///< 0 to 1, see `mixture_of`
  Lanes fine{};         ///< 0 to 1
  CoarseFlame coarse{}; ///< times 1 - fine
  Lanes height{};       ///< over the ground, in drawn lengths
  Lanes length{};       ///< of the flames, m
  Lanes drawn{};        ///< length at which they are drawn, m: at least some pixels
  Lanes share{};        ///< of the ground that burns, 0 to 1
  float lowest = std::numeric_limits<float>::max(); ///< height of the lowest flames, m
  bool any = false;
};

/// Gas at eight points, of three kinds that overlap.
struct FlameSamples {
  static constexpr std::size_t kinds = 3; ///< front, low flames behind it, crowns
  using Codes = std::array<float, kinds>;
  std::array<GasLanes, kinds> gas;
  Codes codes(std::size_t lane) const {
    return {gas[0].code[lane], gas[1].code[lane], gas[2].code[lane]};
  }
  float lowest() const { return std::min({gas[0].lowest, gas[1].lowest, gas[2].lowest}); }
  bool any() const { return gas[0].any || gas[1].any || gas[2].any; }
};

/// Flames as a function of place and time: solved fires, scaled by the length of the flames.
///
/// Lengths go with L and times with sqrt(L / g) (Froude scaling: P. H. Thomas 1963, "The size of
/// flames from natural fires", Symp. (Int.) Combust. 9, 844-859).
/// Across the front a point's place in a block is its foot's distance from the front over L; along
/// the front, and in time, L is rounded to a power of 2, so that the pattern does not slide where L
/// changes. Segments along the front take other parts of other blocks at other times, by a hash,
/// and each loop of a segment takes another part too: flames do not repeat. Wind chooses the block,
/// and its rest leans the flames. Behind the front low flames stand in rows. Nothing depends on
/// other times or on the camera.
class FlameField {
public:
  static constexpr float below_ground = 0.5F; ///< m below the map's ground that still burns
  static constexpr float wide_pixels = 1.5F;  ///< least length of drawn flames, pixels
  static constexpr float lean =
      0.5F; ///< share of the wind beyond the solved fire's by which flames lean (by eye)

  /// @param shape wind that carries flames, without `lean`
  FlameField(const FlameTiles& tiles, const FlameCrowns& crowns, const FlameLibrary& library,
             const FlameShape& shape, const Vector& origin, double time);

  /// Evaluates eight points close together, relative to the origin, m.
  /// @param size size of a pixel there, m
  void evaluate(const Lanes& x, const Lanes& y, const Lanes& z, float size,
                FlameSamples& out) const;

  /// Speed at most, m/m, of the foot of the gas along a ray; the wind shears flames as much.
  float foot_speed(float height, const std::array<float, 3>& direction) const;
  /// Returns a distance (m) from a place in a direction within which nothing burns; 0 near flames.
  /// @param height over the ground, m
  float free_distance(const std::array<float, 3>& place, float height,
                      const std::array<float, 3>& direction) const;

private:
  struct Foot;
  struct Line;
  struct Octave;
  class Octaves;
  struct Segment;

  void find_foot(const Lanes& x, const Lanes& y, const Lanes& height, const NodeLanes& node,
                 Foot& out) const;
  void add_front(const Foot& foot, const Lanes& height, float size, GasLanes& out) const;
  void add_low(const Foot& foot, const Lanes& height, float size, GasLanes& out) const;
  void add_crowns(const Lanes& x, const Lanes& y, const Lanes& z, float size, GasLanes& out) const;
  void add_rows(const Foot& foot, const Octave& octave, const Lanes& height,
                const BlockLevels& levels, GasLanes& out) const;
  void add_line(const Line& line, const Octave& octave, GasLanes& out) const;
  void add_segments(const Line& line, int octave, int direction, const Lanes& weight,
                    GasLanes& out) const;
  void add_segment(const Segment& segment, GasLanes& out) const;

  const FlameTiles& tiles_;
  const FlameCrowns& crowns_;
  const FlameLibrary& library_;
  FlameShape shape_;
  Vector origin_;
  double time_;
};

} // namespace firetwin::flames
