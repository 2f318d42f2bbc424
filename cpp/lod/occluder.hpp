#pragma once

#include "base/vector.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::lod {

/// Bounding sphere of an object.
struct BoundingSphere {
  Vector centre; ///< m
  double radius; ///< m
};

/// Terrain as an occluder for occlusion culling. It stores a lower bound of the surface.
///
/// The bound of a grid cell is the lowest node of all quads that reach into the cell. So it holds
/// for any triangulation of the nodes, and for finer surfaces above these triangles. Cells outside
/// of the surface occlude nothing.
class Occluder {
public:
  /// @param node [rows columns 3] m; the surface joins neighbours in rows and columns
  /// @throws std::invalid_argument for fewer than 2 x 2 nodes and for nodes that are not finite.
  Occluder(std::span<const double> node, std::size_t rows, std::size_t columns);

  /// Returns true if the terrain occludes all of `target` from all of `camera`. All of `camera`
  /// must be above the terrain. The test is conservative: it has no false positives, and it may
  /// miss an occlusion.
  ///
  /// All lines between the two spheres lie in a cone. At the fraction t of the way the cone is
  /// inside a sphere, whose centre and radius are linear in t. The lines are occluded if, for some
  /// t, the terrain over all of this sphere is higher than its top.
  /// @param where fraction t to test first; receives the t of the occlusion. Neighbouring targets
  ///        are mostly occluded at a similar t. The result does not depend on it.
  bool occludes(const BoundingSphere& camera, const BoundingSphere& target, double& where) const;

  /// Returns true if a sphere is entirely below the terrain. Conservative: no false positives.
  bool is_below(const BoundingSphere& sphere) const;

private:
  /// Range of columns and rows, both ends included.
  struct Cells {
    long left, right, low, high;
  };
  /// Level k of the height pyramid: least and greatest bound over blocks of 2^k x 2^k cells.
  struct Blocks {
    long rows, columns;
    std::vector<float> lowest, highest;
  };
  class Lines;

  void add_quad(std::span<const double> node, std::size_t corner, std::size_t columns, bool rim);
  void build_blocks();
  Cells cells(double left, double right, double low, double high) const;
  /// Column or row at a distance (m) from the grid's corner.
  long index(double from_corner) const;
  /// Calls visit(blocks, i) for the few blocks i that cover these cells.
  template <class Visit> void visit(Cells cells, const Visit& visit) const;
  double lowest(const BoundingSphere& sphere) const;
  double highest(Cells cells) const;

  double x_ = 0.0, y_ = 0.0, cell_ = 1.0; ///< corner of the grid and side of its cells, m
  std::vector<Blocks> blocks_;
};

} // namespace firetwin::lod
