#pragma once

#include "base/grid.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace firetwin::terrain {

/// Gradient noise of wavelength 1 on the plane, about -1 to 1 (Perlin 2002: quintic fade).
double perlin(double x, double y, std::int64_t seed);

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

/// The ground between the points of a grid, seen closely: smooth (Catmull and Rom 1974), with
/// relief.
///
/// Its rows and columns are `cell` metres apart, as relief counts them.
class Surface {
public:
  /// @param elevation m, two rows and columns or more
  /// @param steep how far relief is that of a slope of 45 degrees, 0..1, as many
  /// @param dry 0 on water, where there is no relief, 1 elsewhere, as many
  /// @throws std::invalid_argument
  Surface(Grid<double> elevation, std::vector<float> steep, std::vector<float> dry,
          double cell_north, double cell_east, Relief relief);

  std::size_t rows() const { return elevation_.rows; }
  std::size_t columns() const { return elevation_.columns; }

  /// Height (m) seen closely, less the bilinear one, at a fractional row and column of the grid.
  double detail(double row, double column) const;

private:
  struct Place;
  Place place(double row, double column) const;
  double smooth(const Place& at) const;
  double relief(const Place& at, double row, double column) const;

  Grid<double> elevation_;
  std::vector<float> steep_, dry_;
  double cell_north_, cell_east_;
  Relief relief_;
};

} // namespace firetwin::terrain
