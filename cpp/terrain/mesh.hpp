#pragma once

#include "base/vector.hpp"
#include "terrain/surface.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::terrain {

/// The places of a grid's points, and how exactly a mesh must follow them.
struct Survey {
  std::size_t rows, columns;
  std::span<const float> place;       ///< [rows columns 3] m; x ascends with columns, y with rows
  std::span<const float> tolerance;   ///< [rows columns] m, the largest vertical error
  std::span<const std::uint8_t> fine; ///< [rows - 1, columns - 1] how often a cell is halved where
                                      ///< heights between the grid's points count; empty: nowhere
  std::size_t margin = 0;             ///< rows and columns at each side whose triangles stay small
  std::size_t widest = 4;             ///< cells that a triangle spans there at most
};

/// What is added to a grid seen from near by.
struct Close {
  const Surface* surface = nullptr; ///< null: nothing
  std::span<const double> eye;      ///< [m 3] m
  double radius = 0.0;              ///< m; all of it within 0.6 of this from an eye, nothing beyond
};

/// Triangles, counter-clockwise seen from above.
struct Mesh {
  std::vector<double> row, column;    ///< of each vertex, fractional
  std::vector<std::int32_t> triangle; ///< [n 3] vertices
};

/// Adaptive triangle mesh whose vertical error is nowhere above the tolerance: at no point of the
/// grid, nor where `fine` asks for more at any point of the halved cells.
///
/// Right triangles are halved from two that cover all (newest vertex bisection; Lindstrom et al.
/// 1996, "Real-time, continuous level of detail rendering of height fields"; Evans et al. 2001,
/// "Right-triangulated irregular networks"). Each is compared with every point in it and halved
/// where it is off; the neighbour across its longest side is halved with it, so that there are no
/// cracks. A triangle that becomes a neighbour's half is compared as well. The mesh depends on
/// nothing but what is given, whatever the number of threads.
/// @throws std::invalid_argument
Mesh mesh(const Survey& survey, const Close& close);

} // namespace firetwin::terrain
