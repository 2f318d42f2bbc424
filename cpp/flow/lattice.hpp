#pragma once

#include <cstddef>
#include <vector>

namespace firetwin::flow {

using Index = std::ptrdiff_t;

/// Ghost cells on each side, in x and in y: as many as a stencil reaches.
inline constexpr Index halo = 2;

/// SIMD width, floats; rows are processed in multiples of it.
inline constexpr Index lanes = 16;
constexpr Index whole_lanes(Index n) {
  return (n + lanes - 1) / lanes * lanes;
}

/// nx by ny by nz cells on a staggered (Arakawa C) grid. Scalars sit in cells' middles, u on faces
/// i = 0 to nx across x, v on faces j = 0 to ny across y, w on faces k = 0 to nz. Squares in x and
/// y; levels of any thickness in z', the height above ground.
struct Lattice {
  Lattice(Index columns, Index rows, double cell, std::vector<double> levels);

  Index nx;
  Index ny;
  Index nz;
  double spacing;             ///< m
  std::vector<double> face;   ///< [nz + 1] z' of the faces, m, from 0 up
  std::vector<double> middle; ///< [nz] z' of cells' middles
  std::vector<double> depth;  ///< [nz] m
  Index stride;               ///< floats from a row to the next
  Index plane;                ///< floats from a level to the next

  double top() const { return face.back(); }
  /// From the middle of the cell below face k to the middle of the one above, m; 0 < k < nz.
  double gap(Index k) const;
};

} // namespace firetwin::flow
