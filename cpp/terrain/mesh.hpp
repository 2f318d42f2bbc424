#pragma once

#include "base/vector.hpp"
#include "terrain/surface.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::terrain {

/// Grid points and the tolerance of the mesh.
struct MeshInput {
  std::size_t rows, columns;
  std::span<const float> place;     ///< [rows columns 3] m; x ascends with columns, y with rows
  std::span<const float> tolerance; ///< [rows columns] m, the largest vertical error
  std::span<const std::uint8_t> subdivision; ///< [rows - 1, columns - 1] bisections of each cell
                                             ///< whose interior heights count; empty: none
  std::size_t margin = 0;                    ///< rows and columns at each side with small triangles
  std::size_t max_span = 4;                  ///< maximum size of these triangles, cells
};

/// Surface detail near cameras.
struct NearDetail {
  const Surface* surface = nullptr; ///< null: no detail
  std::span<const double> camera;   ///< [m 3] m
  double radius = 0.0; ///< m; full detail within 0.6 radius of a camera, none beyond radius
};

/// Triangles, counter-clockwise seen from above.
struct Mesh {
  std::vector<double> row, column;    ///< fractional row and column of each vertex
  std::vector<std::int32_t> triangle; ///< [n 3] vertices
};

/// Creates an adaptive triangle mesh whose vertical error is within the tolerance at all grid
/// points and at the points of subdivided cells.
///
/// Two right triangles that cover the grid are bisected (newest vertex bisection; Lindstrom et al.
/// 1996, "Real-time, continuous level of detail rendering of height fields"; Evans et al. 2001,
/// "Right-triangulated irregular networks"). Each triangle is compared with all points in it and
/// bisected if its error is too large; the neighbour across the hypotenuse is bisected with it, so
/// that no cracks appear. Triangles that result from a neighbour's bisection are compared as well.
/// The mesh does not depend on the number of threads.
/// @throws std::invalid_argument
Mesh mesh(const MeshInput& input, const NearDetail& detail);

} // namespace firetwin::terrain
