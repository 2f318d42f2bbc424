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
/// Caches the gradients of the last cell, so that consecutive nearby points are much cheaper.
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

/// One octave of the relief.
struct Octave {
  double size;   ///< wavelength, m
  double weight; ///< weight of its amplitude
};

/// Relief finer than a grid, stronger on slopes: ridges and gullies by gradient noise.
struct Relief {
  std::vector<Octave> octaves;
  double strength = 0.0; ///< amplitude on slopes of 45 degrees, m
  double level = 0.0;    ///< amplitude on level ground, relative to strength
  double sharp = 0.0;    ///< sharpness of ridges (ridged noise)
  double mean = 0.0;     ///< mean of the sum of octaves
  std::int64_t seed = 0;
};

/// Heights of a finer elevation model in a part of the grid: a lattice of `parts` points per cell
/// along both axes, which starts at a grid point.
struct Patch {
  std::size_t row = 0, column = 0; ///< grid point of its first value
  std::size_t parts = 1;
  std::size_t rows = 0, columns = 0; ///< size of the lattice; 0: no patch
  std::vector<float> offset;         ///< height above the bilinear grid, m
  std::vector<float> share;          ///< 0..1, weight relative to the procedural surface
};

/// Ground surface between grid points: Catmull-Rom interpolation (Catmull and Rom 1974) with
/// procedural relief, or a patch of finer data.
///
/// Relief uses a spacing of rows and columns of `cell` metres.
class Surface {
public:
  /// @param elevation m, at least two rows and columns
  /// @param steep weight of the relief of 45 degree slopes, 0..1, same shape
  /// @param dry 0 on water, which has no relief, 1 elsewhere, same shape
  /// @param patch finer heights
  /// @throws std::invalid_argument
  Surface(Grid<double> elevation, std::vector<float> steep, std::vector<float> dry,
          double cell_north, double cell_east, Relief relief, Patch patch);

  std::size_t rows() const { return elevation_.rows; }
  std::size_t columns() const { return elevation_.columns; }

  /// Creates noise caches for a sequence of nearby points.
  std::vector<Wave> waves() const;

  /// Height above the bilinear grid, m, at a fractional row and column.
  /// @param waves from `waves()`
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
