#pragma once

#include "base/buffer.hpp"
#include "forest/planting_site.hpp"
#include "geo/ellipsoid.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::forest {

/// Nodes and cells of one axis.
struct Axis {
  explicit Axis(std::span<const double> nodes);
  std::span<const double> value; ///< degrees
  std::vector<double> first;     ///< start of the cell
  std::vector<double> width;     ///< signed width of the cell
  std::vector<double> before;    ///< 1 / (previous value - value), 0 without one
  std::vector<double> after;     ///< 1 / (next value - value), 0 without one
};

/// Positions of the plants in a row of cells: jittered inside the cells, on the bilinear elevation.
class Placement {
public:
  /// @param site must outlive this object
  explicit Placement(const PlantingSite& site);

  /// Returns true if a cell has an elevation, so that it can have plants.
  bool has_elevation(std::size_t cell) const { return std::isfinite(site_.elevation[cell]); }

  /// Random numbers (input) and positions in local metres (output), one per column.
  struct Row {
    explicit Row(std::size_t columns);
    Buffer<double> north, east;      ///< in [0, 1): position in the cell along the axes
    Buffer<double> x, y, z;          ///< m
    Buffer<double> below, on, above; ///< elevations of three rows, padded by one value on each side
  };
  /// Computes the positions in columns first to last - 1 of a row. Corners without elevation are
  /// skipped, and the other weights are renormalized.
  void place(std::size_t y, std::size_t first, std::size_t last, Row& row) const;

private:
  void copy_row(std::size_t y, std::size_t first, std::size_t last, Buffer<double>& out) const;

  const PlantingSite& site_;
  geo::Origin origin_;
  Axis latitude_, longitude_;
  std::vector<double> sine_, cosine_; ///< of longitudes relative to the origin
};

} // namespace firetwin::forest
