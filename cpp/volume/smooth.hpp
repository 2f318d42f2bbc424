#pragma once

#include "volume/depth.hpp"
#include "volume/puffs.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::volume {

/// Flames as lights: positions (n, 3) m and powers (n,) W.
struct Flames {
  std::span<const double> position;
  std::span<const double> power;
};

/// Radius over which the mass of a puff of radius R is spread, m: to the far side of its surface
/// balls, and at least so far that it cannot fall between the nodes below, which are four voxels
/// apart.
inline float spread(float radius, float voxel_size) {
  return std::max(1.5F * radius + 60.0F, 3.6F * voxel_size);
}

/// A smooth field on 3^3 nodes, four voxels apart, shared with the neighbouring leaves. Each row of
/// three along z has a fourth, unused value.
using Nodes = std::array<double, 9 * 4>;

/// Mass of puffs, spread in space, for evaluation at many points.
class SpreadMass {
public:
  SpreadMass(const Puffs& puffs, float voxel_size);

  /// Computes kg/m3 at the nodes of the leaf whose first voxel is centred on `corner`: each puff is
  /// 21 M / (16 pi s^3) (1 - r^4 / s^4), s = spread(radius, voxel_size). `balls` are numbers of
  /// puffs.
  Nodes at_nodes(const std::array<float, 3>& corner, float voxel_size,
                 std::span<const std::uint32_t> balls) const;

private:
  struct Ball {
    std::array<double, 3> position;
    double inverse; ///< 1 / s^2, 1/m2
    double weight;  ///< kg/m3 at the centre
  };
  std::vector<Ball> balls_;
};

/// Computes the glow of flames at the nodes of a leaf, see write_smoke.
Nodes glow_at_nodes(const std::array<float, 3>& corner, float voxel_size, const Flames& flames);

/// Returns the largest value at a node.
double largest(const Nodes& nodes);

/// Interpolates trilinearly between nodes, axis by axis for complete rows (fractions are multiples
/// of 1/4).
void interpolate(const Nodes& nodes, LeafValues& values);

} // namespace firetwin::volume
