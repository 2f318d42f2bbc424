#pragma once

#include "volume/dense.hpp"
#include "volume/leaf.hpp"

#include <openvdb/openvdb.h>

#include <optional>

namespace firetwin::volume {

/// Sums and validity of a dense field that was converted to a grid.
struct DenseLeaves {
  double sum = 0.0;                  ///< of all active values
  double culled_sum = 0.0;           ///< of the values in culled leaves, if requested
  std::optional<openvdb::Coord> bad; ///< first voxel with an invalid value
};

/// Copies the values of the leaf at `origin`; 0 beyond the field.
void copy_leaf(const DenseField& field, const openvdb::Coord& origin, LeafValues& values);

/// Adds the leaves of a field to a tree, without values, and its tiles. Culled leaves are skipped
/// unless `sum_culled` is set. Leaves that `within` does not have are always skipped (null: none).
DenseLeaves find_leaves(const DenseField& field, const DenseSettings& settings, bool sum_culled,
                        const openvdb::FloatTree* within, openvdb::FloatTree& tree);

} // namespace firetwin::volume
