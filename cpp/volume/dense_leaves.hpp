#pragma once

#include "volume/dense.hpp"
#include "volume/leaf.hpp"

#include <optional>
#include <vector>

namespace firetwin::volume {

/// Leaves of a dense field, sorted by origin, their sums and their validity.
struct DenseLeaves {
  Leaves leaves;
  std::vector<Tile> tiles;
  double sum = 0.0;         ///< of all active values
  double culled_sum = 0.0;  ///< of the values in culled leaves, if requested
  std::optional<Coord> bad; ///< first voxel with an invalid value
};

/// Copies the values of the leaf at `origin`; 0 beyond the field.
void copy_leaf(const DenseField& field, const Coord& origin, LeafValues& values);

/// Finds the leaves and tiles of a field. Culled leaves are skipped unless `sum_culled` is set.
/// Leaves that `within` does not have are always skipped (null: none).
DenseLeaves find_leaves(const DenseField& field, const DenseSettings& settings, bool sum_culled,
                        const DenseLeaves* within);

} // namespace firetwin::volume
