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
using LeafMask = openvdb::FloatTree::LeafNodeType::NodeMaskType;

/// First voxel of the leaf at `place`, which is counted in leaves.
openvdb::Coord first_voxel(const openvdb::Coord& place);

/// Centre of a leaf's lowest voxel, m.
std::array<float, 3> corner_of(const openvdb::Coord& origin, float voxel_size);

/// Integral over active voxels.
double mass_of(const LeafMask& mask, const LeafValues& values, double voxel_size);

/// @throws Error for more leaves than memory could ever hold.
void check_leaf_count(std::uint64_t count, double voxel_size);

} // namespace firetwin::volume
