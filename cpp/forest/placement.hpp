#pragma once

#include "base/buffer.hpp"
#include "forest/planting_site.hpp"
#include "geo/ellipsoid.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::forest {

/// One axis, by its nodes.
struct Axis {
  explicit Axis(std::span<const double> nodes);
  std::span<const double> value; ///< degrees
  std::vector<double> first;     ///< where the cell begins
  std::vector<double> width;     ///< of the cell, with its sign
  std::vector<double> before;    ///< 1 / (previous value - value), 0 without one
  std::vector<double> after;     ///< 1 / (next value - value), 0 without one
};

/// Where the plants of a row of cells stand: jittered inside their cells, on the bilinear
/// elevation.
class Placement {
public:
  /// @param site must outlive this
  explicit Placement(const PlantingSite& site);

  /// Whether a cell has an elevation, so that plants can stand in it.
  bool has_elevation(std::size_t cell) const { return std::isfinite(site_.elevation[cell]); }

  /// Random numbers in, places in local metres out, one each per column.
  struct Row {
    explicit Row(std::size_t columns);
    Buffer<double> north, east;      ///< in [0, 1): where in the cell, towards the axes' ends
    Buffer<double> x, y, z;          ///< m
    Buffer<double> below, on, above; ///< the elevations of three rows, an edge on either side
  };
  /// Fills in the columns first to last - 1 of a row. Corners of a cell's ground without elevation
  /// are left out (the others' weights grow).
  void place(std::size_t y, std::size_t first, std::size_t last, Row& row) const;

private:
  void copy_row(std::size_t y, std::size_t first, std::size_t last, Buffer<double>& out) const;

  const PlantingSite& site_;
  geo::Origin origin_;
  Axis latitude_, longitude_;
  std::vector<double> sine_, cosine_; ///< of the longitudes from the origin's
};

} // namespace firetwin::forest
