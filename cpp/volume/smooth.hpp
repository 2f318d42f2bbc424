#pragma once

#include "volume/depth.hpp"
#include "volume/puffs.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::volume {

/// Light of flames: positions (n, 3) m and powers (n,) W.
struct Flames {
  std::span<const double> position;
  std::span<const double> power;
};

/// How far the mass of a puff of radius R is spread, m: to the far side of the balls on its
/// surface, and never so little that it could lie between the nodes below, four voxels apart.
inline float spread(float radius, float voxel_size) {
  return std::max(1.5F * radius + 60.0F, 3.6F * voxel_size);
}

/// A smooth field on 3^3 nodes, four voxels apart, that neighbouring leaves share. Each row of
/// three along z ends with a fourth value that means nothing.
using Nodes = std::array<double, 9 * 4>;

/// The mass of puffs, spread, ready to be summed at many places.
class SpreadMass {
public:
  SpreadMass(const Puffs& puffs, float voxel_size);

  /// kg/m3 at the nodes of the leaf whose lowest voxel is centred on `corner`: each puff is 21 M /
  /// (16 pi s^3) (1 - r^4 / s^4), s = spread(radius, voxel_size). `balls` are numbers of puffs.
  Nodes at_nodes(const std::array<float, 3>& corner, float voxel_size,
                 std::span<const std::uint32_t> balls) const;

private:
  struct Ball {
    std::array<double, 3> position;
    double inverse; ///< 1 / s^2, 1/m2
    double weight;  ///< kg/m3 in the middle
  };
  std::vector<Ball> balls_;
};

/// Glow of flames at the nodes of a leaf, see write_smoke.
Nodes glow_at_nodes(const std::array<float, 3>& corner, float voxel_size, const Flames& flames);

/// Largest value at a node.
double largest(const Nodes& nodes);

/// Trilinear values in between, at quarters of the way alone: axis after axis for whole rows.
void interpolate(const Nodes& nodes, LeafValues& values);

} // namespace firetwin::volume
