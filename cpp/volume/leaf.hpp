#pragma once

#include "volume/coord.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Leaves: the blocks of 8^3 voxels that OpenVDB's trees consist of. Smoke is computed leaf by
/// leaf.
namespace firetwin::volume {

constexpr std::size_t leaf_side = 8;
constexpr std::size_t leaf_voxels = leaf_side * leaf_side * leaf_side;

/// One value per voxel of a leaf, z fastest.
using LeafValues = std::array<float, leaf_voxels>;

/// Active voxels of a leaf, in OpenVDB's memory layout: one bit per voxel, z fastest.
struct LeafMask {
  std::array<std::uint64_t, leaf_voxels / 64> words{};

  void set(std::size_t voxel) { words[voxel / 64] |= std::uint64_t{1} << voxel % 64; }
  bool is_empty() const {
    return std::all_of(words.begin(), words.end(), [](std::uint64_t word) { return word == 0; });
  }
  bool is_full() const {
    return std::all_of(words.begin(), words.end(), [](std::uint64_t word) { return ~word == 0; });
  }

  /// Calls `visit(voxel)` for each active voxel, in ascending order.
  template <class Visit> void each(const Visit& visit) const {
    for (std::size_t i = 0; i < words.size(); ++i) {
      for (std::uint64_t bits = words[i]; bits != 0; bits &= bits - 1) {
        visit(i * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
      }
    }
  }
};

/// Origins and active masks of leaves.
struct Leaves {
  std::vector<Coord> origins; ///< first voxels
  std::vector<LeafMask> masks;

  std::size_t size() const { return origins.size(); }
  void add(const Coord& origin, const LeafMask& mask) {
    origins.push_back(origin);
    masks.push_back(mask);
  }
};

/// A leaf whose voxels are all active and have the same value.
struct Tile {
  Coord origin;
  float value;
};

/// Returns the first voxel of the leaf with index `place`.
Coord first_voxel(const Coord& place);

/// Returns the centre of a leaf's first voxel, m.
std::array<float, 3> corner_of(const Coord& origin, float voxel_size);

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
