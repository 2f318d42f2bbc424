#pragma once

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>

/// Leaves: the blocks of 8^3 voxels that OpenVDB's trees are made of, and that smoke is computed
/// in.
namespace firetwin::volume {

constexpr std::size_t leaf_side = 8;
constexpr std::size_t leaf_voxels = leaf_side * leaf_side * leaf_side;

/// A value for each voxel of a leaf, z running fastest.
using LeafValues = std::array<float, leaf_voxels>;
using Leaf = openvdb::FloatTree::LeafNodeType;
using LeafMask = Leaf::NodeMaskType;

/// First voxel of the leaf at `place`, which is counted in leaves.
openvdb::Coord first_voxel(const openvdb::Coord& place);

/// Centre of a leaf's lowest voxel, m.
std::array<float, 3> corner_of(const openvdb::Coord& origin, float voxel_size);

/// Integral over active voxels.
double mass_of(const LeafMask& mask, const LeafValues& values, double voxel_size);

/// @throws std::invalid_argument unless it is 0.1 mm to 1000 km
void check_voxel_size(double voxel_size);

/// The leaf, counted along an axis, that a place (m) lies in.
/// @throws Error where voxels are so small that they cannot be counted
int leaf_number(double place, double voxel_size);

/// @param count of leaves; a double, for it may be more than an integer holds
/// @throws Error for more leaves than memory could ever hold.
void check_leaf_count(double count, double voxel_size);

} // namespace firetwin::volume
