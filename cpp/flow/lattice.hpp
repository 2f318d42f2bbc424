#pragma once

#include <cstddef>
#include <vector>

namespace firetwin::flow {

using Index = std::ptrdiff_t;

/// Ghost cells on each side, in x and in y: the range of the stencils.
inline constexpr Index halo = 2;

/// SIMD width, floats; rows are processed in multiples of it.
inline constexpr Index lanes = 16;
constexpr Index whole_lanes(Index n) {
  return (n + lanes - 1) / lanes * lanes;
}

/// Staggered (Arakawa C) grid of nx by ny by nz cells. Scalars are at cell centres, u on faces i =
/// 0 to nx across x, v on faces j = 0 to ny across y, w on faces k = 0 to nz. Cells are square in x
/// and y; levels may have any thickness in z', the height above ground.
struct Lattice {
  Lattice(Index columns, Index rows, double cell, std::vector<double> levels);

  Index nx;
  Index ny;
  Index nz;
  double spacing;             ///< m
  std::vector<double> face;   ///< [nz + 1] z' of the faces, m, from 0 up
  std::vector<double> middle; ///< [nz] z' of cell centres
  std::vector<double> depth;  ///< [nz] thickness, m
  Index stride;               ///< floats between rows: full lanes, and one for ghost cells
  Index plane;                ///< floats between levels

  double top() const { return face.back(); }
  /// Distance between the centres of the cells below and above face k, m; 0 < k < nz.
  double gap(Index k) const;
};

} // namespace firetwin::flow
