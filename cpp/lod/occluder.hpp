#pragma once

#include "base/vector.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::lod {

/// Everything within `radius` of `centre`.
struct Ball {
  Vector centre;
  double radius;
};

/// The ground as what hides things: a continuous surface of which only a lower bound is kept.
///
/// Over each cell of a regular grid it is the lowest node of all quads that reach into the cell, so
/// the surface may be drawn by any triangles between its nodes, and finer ones above them. Cells
/// that it does not cover hide nothing.
class Occluder {
public:
  /// @param node [rows columns 3] m: neighbours in rows and columns are joined by the surface
  /// @throws std::invalid_argument for fewer than 2 x 2 nodes and for what is not finite.
  Occluder(std::span<const double> node, std::size_t rows, std::size_t columns);

  /// Whether the ground hides all of `thing` from every place of `camera`, whose places are all
  /// above the ground.
  ///
  /// Straight lines between the two run, at the fraction t of their way, inside a ball round the
  /// line between the centres whose radius goes from one's to the other's. If for some t the ground
  /// over all of that ball is higher than its top, each of the lines is under the ground there, so
  /// each has gone through it. What is called hidden is hidden; what only just hides may not be
  /// called so.
  /// @param where the t that is tried first; becomes the one at which the ground hides it. What
  ///        hides one thing from one place most often hides the next one too. It decides nothing.
  bool hides(const Ball& camera, const Ball& thing, double& where) const;

  /// Whether all of a ball is under the ground.
  bool buries(const Ball& ball) const;

private:
  /// Columns and rows, both inclusive.
  struct Cells {
    long left, right, low, high;
  };
  /// Bounds of the lowest surface over blocks of 2^k x 2^k cells.
  struct Blocks {
    long rows, columns;
    std::vector<float> lowest, highest;
  };
  class Lines;

  void add_quad(std::span<const double> node, std::size_t corner, std::size_t columns, bool rim);
  void build_blocks();
  Cells cells(double left, double right, double low, double high) const;
  /// Column or row of what is so far (m) from the grid's corner.
  long index(double from_corner) const;
  /// Calls visit(blocks, i) for the few blocks i that cover these cells.
  template <class Visit> void visit(Cells cells, const Visit& visit) const;
  double lowest(const Ball& ball) const;
  double highest(Cells cells) const;

  double x_ = 0.0, y_ = 0.0, cell_ = 1.0; ///< corner of the grid and side of its cells, m
  std::vector<Blocks> blocks_;
};

} // namespace firetwin::lod
