#pragma once

#include "base/simd.hpp"

#include <oneapi/tbb/collaborative_call_once.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::flames {

using LaneIndex = Simd<std::int32_t, lane_count>;

/// Size of a solved fire: lengths over the flame length L, times over sqrt(L / g).
struct BlockScale {
  float cell;  ///< edge of a cell
  float front; ///< leading edge of the burning strip across the front, from the first cell's face
  float interval; ///< time between frames
  int fade;       ///< number of last frames that fade into the first ones
  float wind;     ///< wind across the front, over sqrt(g L)
  bool periodic;  ///< along the front; else nothing burns beyond the sides
  bool soft;      ///< mean of three cells, weights 1 2 1, up and across
};

/// Eight places in a block, in flame lengths: across and along the front from the first cell's
/// face, and height over the ground.
struct BlockPlaces {
  Lanes across, along, up;
};

/// Extinction over a flame's greatest, and extinction times heat, of eight places.
struct CoarseFlame {
  Lanes extinction{}, hot{};
};

/// Mixture fractions of a solved fire, frame by frame, and coarser levels of its extinction.
///
/// Each level doubles the width of cells. Its extinction lets the same mean share of light through
/// as the columns of cells in it do, and its heat gives the luminance that leaves them, so that
/// flames keep their light and their gaps when pixels are larger than cells.
class FlameBlock {
public:
  static constexpr int levels = 4;           ///< coarser than the cells
  using Shape = std::array<std::int64_t, 4>; ///< frames, and cells up, along and across

  /// @param codes [frames][up][along][across]: 255 sqrt(Z / 4), Z over the stoichiometric one
  /// @param rise [up] mean speed of hot gas, over sqrt(g L)
  /// @throws std::invalid_argument
  FlameBlock(std::span<const std::uint8_t> codes, const Shape& shape, const BlockScale& scale,
             std::span<const float> rise);

  const BlockScale& scale() const { return scale_; }
  float top() const { return scale_.cell * static_cast<float>(shape_[1]); }
  float across() const { return scale_.cell * static_cast<float>(shape_[3]); }
  float along() const { return scale_.cell * static_cast<float>(shape_[2]); }
  /// Time after which the block repeats, over sqrt(L / g).
  double period() const;

  /// Time for which the next loop fades in over the last frames of this one, over sqrt(L / g).
  float fading() const { return scale_.interval * static_cast<float>(scale_.fade); }

  /// Computes the codes, 0 to 1, at eight places and a time since a loop began: up to `fading`
  /// after the period.
  /// @param detail strength, 0 to 1, of eddies that are smaller than cells
  void codes(const BlockPlaces& places, float time, float detail, Lanes& out) const;
  /// Computes a coarser level, from 1 on.
  void coarse(int level, const BlockPlaces& places, float time, CoarseFlame& out) const;

private:
  /// Values of two channels on blocks of cells, with a margin of empty ones.
  struct Level {
    std::vector<std::uint16_t> values; ///< extinction and, 8 bits up, extinction times heat
    std::array<std::int64_t, 3> size;  ///< up, along, across
  };
  /// A stored frame's part in a moment, and how far its gas has risen since, in intervals.
  struct Part {
    std::int64_t frame;
    float weight, risen;
  };
  using Parts = std::array<Part, 2>;

  Parts parts_at(float time) const;
  void soften();
  void mark_burning();
  bool burns(std::int64_t frame, const Lanes& x, const Lanes& y, const Lanes& z) const;
  void rise_at(const Lanes& up, Lanes& cells) const;
  void add_codes(const Part& part, const Lanes& x, const Lanes& y, const Lanes& z,
                 Lanes& out) const;
  void add_coarse(const Level& level, const Part& part, const Lanes& x, const Lanes& y,
                  const Lanes& z, CoarseFlame& out) const;
  const Level& level(int number) const;
  void build_levels() const;

  std::vector<std::uint8_t> codes_;
  Shape shape_;
  BlockScale scale_;
  std::vector<float> rise_; ///< cells in an interval
  /// 1 if something burns in a cube of cells or in its neighbours until the next frame.
  std::vector<std::uint8_t> burning_; // [frame][up][along][across]
  std::array<std::int64_t, 3> cubes_{};
  mutable tbb::collaborative_once_flag built_;
  mutable std::array<Level, levels> levels_;
};

/// Levels of a block that a pixel shows: `number` and, with the share `part`, the next coarser one.
/// Level 0 is the cells themselves.
struct BlockLevels {
  int number;
  float part;
  float detail; ///< strength of eddies that are smaller than cells, 0 to 1

  /// @param pixel, cell size, m
  BlockLevels(float pixel, float cell);
  /// Share of the cells themselves.
  float fine() const { return number == 0 ? 1.0F - part : 0.0F; }
};

} // namespace firetwin::flames
