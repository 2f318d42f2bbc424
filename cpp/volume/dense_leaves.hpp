#pragma once

#include "volume/dense.hpp"
#include "volume/leaf.hpp"

#include <openvdb/openvdb.h>

#include <optional>

namespace firetwin::volume {

/// What a dense field comes to as a grid.
struct DenseLeaves {
  double sum = 0.0;        ///< of all active values
  double culled_sum = 0.0; ///< of those that would be, in leaves that do not count; see find_leaves
  std::optional<openvdb::Coord> bad; ///< the first voxel whose value cannot be held
};

/// Values of the leaf at `origin`; 0 beyond the field.
void copy_leaf(const DenseField& field, const openvdb::Coord& origin, LeafValues& values);

/// Gives a tree the leaves of a field, without values, and tiles. Leaves that do not count are not
/// looked at, unless their sum is `wanted`, nor those that `within`, if there is one, does not
/// have.
DenseLeaves find_leaves(const DenseField& field, const DenseSettings& settings, bool wanted,
                        const openvdb::FloatTree* within, openvdb::FloatTree& tree);

} // namespace firetwin::volume
