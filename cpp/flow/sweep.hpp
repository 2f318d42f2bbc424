#pragma once

#include "flow/field.hpp"

#include <array>
#include <span>
#include <vector>

namespace firetwin::flow {

enum class Axis { x, y, z };

/// Position of values on the staggered grid: cell centres, or half a cell below along an axis.
enum class Place { middle, x, y, z };

/// Scalar mass through the lateral boundaries, scalar x kg/m2, by level.
struct BoundaryFlux {
  double in = 0.0;
  double out = 0.0;
};

/// Advection along one direction, in flux form (dimensional splitting). Air mass and scalars pass
/// through the same faces, so constants stay constant and sums are conserved. The air mass of cells
/// changes between directions and is restored after all three.
struct Sweep {
  const Lattice& lattice;
  Axis axis;
  Place place;
  const Field& flux; ///< through cell faces across `axis`, kg per m2 of the cell's ground
  const Field& mass; ///< of cells before this sweep, kg/m2
  const float* rest; ///< [nz] reference air mass of a cell, kg/m2
  std::span<Field* const> fields; ///< advected, at most `max_fields`
  /// In the last direction: number of leading fields that are rescaled to `rest`. Otherwise 0.
  std::size_t rescaled;
  /// Number of leading fields that are 0 in most of the domain; their zero rows are skipped.
  std::size_t sparse;
  const Field& exchange; ///< air that eddies exchange through the same faces, kg/m2
  float mixing;          ///< factor on `exchange`
};

inline constexpr std::size_t max_fields = 4;

/// Sweeps fields at several places, the last of them z, along x or y within level k.
/// @param crossed [fields] boundary fluxes of the fields at cell centres are added to it
void sweep_level(std::span<const Sweep> sweeps, Index k, std::span<BoundaryFlux> crossed);

/// Sweeps fields at several places along z in row j.
void sweep_columns(std::span<const Sweep> sweeps, Index j);

} // namespace firetwin::flow
