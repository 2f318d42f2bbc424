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
  /// For the last direction: reference air mass of a cell, kg/m2 by level. Otherwise empty.
  std::span<const float> rest;
  /// Advected fields, at most `max_fields`, and the number of fields that are rescaled to `rest`.
  std::span<Field* const> fields;
  std::size_t rescaled = 0;
  /// Number of leading fields that are 0 in most of the domain; their zero rows are skipped.
  std::size_t sparse = 0;
  /// Air that eddies exchange through the same faces, kg/m2, or null, and a factor on it.
  const Field* exchange = nullptr;
  float mixing = 1.0F;
};

inline constexpr std::size_t max_fields = 4;

/// Sweeps along x or y within level k.
/// @param crossed [fields] boundary fluxes are added to it, for values at cell centres; may be
/// empty
void sweep_level(const Sweep& sweep, Index k, std::span<BoundaryFlux> crossed);

/// Sweeps along z in row j.
void sweep_columns(const Sweep& sweep, Index j);

} // namespace firetwin::flow
