#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::tiles {

/// What a tile is, as bits.
enum Flag : std::uint8_t {
  replaces = 1,      ///< its children replace it (REPLACE); otherwise they are added to it (ADD)
  unconditional = 2, ///< refined whatever its error: it has no content, or holds another tileset
  content = 4,       ///< has something to show
  pending = 8,       ///< has children that are not read yet
  broken = 16,       ///< its content cannot be had
  outside_request_volume = 32, ///< no eye is in its viewer request volume
  pass_through = 64 ///< stands for its children: it asks for them as it was asked for (a holder)
};

/// A tree of n tiles as flat arrays.
struct Tree {
  std::span<const std::int64_t> parent;    ///< [n] smaller than the tile's own number; -1: a root
  std::span<const std::uint8_t> flags;     ///< [n]
  std::span<const double> screen_error;    ///< [n] pixels; below 0: no view sees it
  std::span<const std::int64_t> bytes;     ///< [n] of the content, 0 where unknown
  std::span<const std::int64_t> triangles; ///< [n] of the content, 0 where unknown

  std::size_t size() const { return parent.size(); }
};

/// Most of each that a cut may have; negative: no limit.
struct Budget {
  std::int64_t tiles = -1, bytes = -1, triangles = -1;
};

/// The tiles that a shot shows.
struct Cut {
  std::vector<std::int64_t> tiles;  ///< ascending
  std::vector<std::int64_t> expand; ///< pending tiles whose children the cut needs, ascending
  std::vector<std::int64_t> stand_ins; ///< tiles shown in place of descendants that are broken
  std::vector<std::int64_t> missing; ///< broken tiles that the cut would show
  double error = 0.0;               ///< screen-space error to which tiles are refined, pixels
  bool fits = true;                 ///< the cut keeps within the budget
  std::int64_t bytes = 0, triangles = 0;
};

/// Chooses one cut of the tree. A tile is refined where its screen-space error is above `error`,
/// and those that are unconditional always. Children of a tile that they replace are chosen all or
/// none: those that no view sees stay coarse. Children that are added are chosen each by itself.
/// Where a tile of the cut is broken, its nearest ancestor with content stands in.
///
/// Beyond the budget the error is raised for all tiles to the next screen-space error of any tile
/// at which the cut fits, found by bisection.
/// @throws std::invalid_argument where a parent does not come before its child, and for a negative
///         error or a NaN.
Cut select(const Tree& tree, double error, const Budget& budget);

} // namespace firetwin::tiles
