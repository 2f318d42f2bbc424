#pragma once

#include "base/grid.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::terrain {

/// Gradient noise of wavelength 1 on the plane, about -1 to 1 (Perlin 2002: quintic fade).
///
/// It remembers the slopes at the corners of the cell that was asked about last: places that are
/// near each other cost a fraction of those that are not.
class Wave {
public:
  explicit Wave(std::int64_t seed) : seed_(seed) {}
  double operator()(double x, double y);

private:
  using Slope = std::array<double, 2>;
  Slope slope(std::int64_t column, std::int64_t row) const;

  std::int64_t seed_;
  std::int64_t column_ = 0, row_ = 0;
  bool known_ = false;
  std::array<Slope, 4> slopes_{}; ///< low left, low right, high left, high right
};

/// A wave of relief.
struct Octave {
  double size;   ///< wavelength, m
  double weight; ///< of its shape
};

/// Relief finer than a grid, stronger on slopes: ridges and gullies by gradient noise.
struct Relief {
  std::vector<Octave> octaves;
  double strength = 0.0; ///< m where slopes are 45 degrees
  double level = 0.0;    ///< strength on level ground, as a part of it
  double sharp = 0.0;    ///< how much lower than its ridges a wave is
  double mean = 0.0;     ///< of the waves together
  std::int64_t seed = 0;
};

/// Heights known more finely than by the grid, in a part of it: a lattice of `parts` points to a
/// cell along both axes, from a point of the grid on.
struct Patch {
  std::size_t row = 0, column = 0; ///< of its first point on the grid
  std::size_t parts = 1;
  std::size_t rows = 0, columns = 0; ///< of the lattice; 0: there is none
  std::vector<float> offset;         ///< height less the bilinear one of the grid, m
  std::vector<float> share;          ///< 0..1, how far it counts in place of the surface's own
};

/// The ground between the points of a grid, seen closely: smooth (Catmull and Rom 1974), with
/// relief; or as a patch knows it.
///
/// Its rows and columns are `cell` metres apart, as relief counts them.
class Surface {
public:
  /// @param elevation m, two rows and columns or more
  /// @param steep how far relief is that of a slope of 45 degrees, 0..1, as many
  /// @param dry 0 on water, where there is no relief, 1 elsewhere, as many
  /// @param patch what is known of the heights between the grid's points
  /// @throws std::invalid_argument
  Surface(Grid<double> elevation, std::vector<float> steep, std::vector<float> dry,
          double cell_north, double cell_east, Relief relief, Patch patch);

  std::size_t rows() const { return elevation_.rows; }
  std::size_t columns() const { return elevation_.columns; }

  /// The relief's waves, for places that are near each other.
  std::vector<Wave> waves() const;

  /// Height (m) seen closely, less the bilinear one, at a fractional row and column of the grid.
  /// @param waves its own, as `waves` gives them
  double detail(double row, double column, std::span<Wave> waves) const;

private:
  struct Place;
  static Place place(double row, double column, std::size_t rows, std::size_t columns);
  double smooth(const Place& at) const;
  double relief(const Place& at, double row, double column, std::span<Wave> waves) const;

  Grid<double> elevation_;
  std::vector<float> steep_, dry_;
  double cell_north_, cell_east_;
  Relief relief_;
  Patch patch_;
};

} // namespace firetwin::terrain
