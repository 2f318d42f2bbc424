#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::tiles {

/// Flags of a tile, combined by bitwise or.
enum Flag : std::uint8_t {
  replaces = 1,                ///< refinement REPLACE; ADD otherwise
  unconditional = 2,           ///< refined at any error: it has no content, or an external tileset
  content = 4,                 ///< has renderable content
  pending = 8,                 ///< has children that are not loaded yet
  broken = 16,                 ///< its content is not available
  outside_request_volume = 32, ///< no camera is inside its viewer request volume
  pass_through =
      64 ///< parent of an external or implicit tileset: hands its own state to its children
};

/// A tree of n tiles as flat arrays.
struct Tree {
  std::span<const std::int64_t>
      parent; ///< [n] index of the parent, less than the tile's own; -1 for roots
  std::span<const std::uint8_t> flags;     ///< [n]
  std::span<const double> screen_error;    ///< [n] pixels; negative if no view sees the tile
  std::span<const std::int64_t> bytes;     ///< [n] size of the content; 0 if unknown
  std::span<const std::int64_t> triangles; ///< [n] triangles of the content; 0 if unknown

  std::size_t size() const { return parent.size(); }
};

/// Limits of a cut; negative for no limit.
struct Budget {
  std::int64_t tiles = -1, bytes = -1, triangles = -1;
};

/// A cut through the tree: the tiles that a shot shows.
struct Cut {
  std::vector<std::int64_t> tiles;     ///< ascending
  std::vector<std::int64_t> expand;    ///< pending tiles whose children must be loaded, ascending
  std::vector<std::int64_t> stand_ins; ///< tiles shown in place of broken descendants
  std::vector<std::int64_t> missing;   ///< broken tiles that the cut would show
  double error = 0.0;                  ///< maximum screen-space error used, pixels
  bool fits = true;                    ///< the cut is within the budget
  std::int64_t bytes = 0, triangles = 0;
};

/// Selects a cut of the tree. A tile is refined if its screen-space error is above `error` or if it
/// is unconditional. With REPLACE, all children are selected or none; those that no view sees stay
/// coarse. With ADD, each child is selected on its own. The nearest ancestor with content replaces
/// a broken tile.
///
/// If the cut exceeds the budget, `error` is raised to the smallest screen-space error of any tile
/// at which the cut fits, found by bisection.
/// @throws std::invalid_argument if a parent does not come before its child, or an error is
/// negative or NaN
Cut select(const Tree& tree, double error, const Budget& budget);

} // namespace firetwin::tiles
