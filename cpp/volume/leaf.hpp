#pragma once

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>

/// Leaves: the blocks of 8^3 voxels that OpenVDB's trees consist of. Smoke is computed leaf by
/// leaf.
namespace firetwin::volume {

constexpr std::size_t leaf_side = 8;
constexpr std::size_t leaf_voxels = leaf_side * leaf_side * leaf_side;

/// One value per voxel of a leaf, z fastest.
using LeafValues = std::array<float, leaf_voxels>;
using Leaf = openvdb::FloatTree::LeafNodeType;
using LeafMask = Leaf::NodeMaskType;

/// Returns the first voxel of the leaf with index `place`.
openvdb::Coord first_voxel(const openvdb::Coord& place);

/// Returns the centre of a leaf's first voxel, m.
std::array<float, 3> corner_of(const openvdb::Coord& origin, float voxel_size);

/// Integrates over active voxels.
double mass_of(const LeafMask& mask, const LeafValues& values, double voxel_size);

/// @throws std::invalid_argument unless the size is 1e-4 to 1e6 m
void check_voxel_size(double voxel_size);

/// Returns the leaf index, along an axis, of a coordinate (m).
/// @throws Error if voxels are so small that the index overflows
int leaf_number(double place, double voxel_size);

/// @param count number of leaves; a double, as it may exceed the range of integers
/// @throws Error if memory could not hold so many leaves
void check_leaf_count(double count, double voxel_size);

} // namespace firetwin::volume
