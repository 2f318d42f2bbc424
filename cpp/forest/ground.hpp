#pragma once

#include "forest/site.hpp"
#include "geo/axis.hpp"
#include "geo/ellipsoid.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::forest {

/// Where plants stand: jittered inside their cells, on the bilinear elevation.
class Ground {
public:
  explicit Ground(const Site& site);

  /// Whether place() finds a height in every cell.
  bool whole() const { return whole_; }

  /// Writes where the plant of a cell stands, in local metres; false where there is no elevation.
  bool place(std::size_t y, std::size_t x, double* out) const;

private:
  /// Two neighbouring nodes of an axis.
  struct Interval {
    std::size_t lower;
    std::size_t upper;
    double start; ///< of the lower one, degrees
    double width; ///< to the upper one
  };
  /// One row or column of cells.
  struct Line {
    double value;         ///< of the axis, degrees
    geo::Extent extent;   ///< of the cell
    Interval before;      ///< towards extent.first
    Interval after;       ///< towards extent.last
    geo::SineCosine turn; ///< of the latitude, or of the longitude from the origin's
  };
  struct Spot;

  static std::vector<Line> lines(std::span<const double> axis);
  static Spot spot(const Line& line, double random, double jitter, double limit);
  double height(const geo::Bracket& y, const geo::Bracket& x) const;

  const Site& site_;
  geo::Origin origin_;
  std::vector<Line> rows_, columns_;
  bool whole_;
};

} // namespace firetwin::forest
