#pragma once

#include "volume/leaf.hpp"

#include <array>
#include <span>

namespace firetwin::volume {

/// Flames as lights: positions (n, 3) m and powers (n,) W.
struct FlameLights {
  std::span<const double> position;
  std::span<const double> power;
};

/// A smooth field on 3^3 nodes, four voxels apart, shared with the neighbouring leaves. Each row of
/// three along z has a fourth, unused value.
using Nodes = std::array<double, 9 * 4>;

/// Computes the glow of flames at the nodes of a leaf, see GridRequest.
Nodes glow_at_nodes(const std::array<float, 3>& corner, float voxel_size,
                    const FlameLights& flames);

/// Interpolates trilinearly between nodes, axis by axis for complete rows (fractions are multiples
/// of 1/4).
void interpolate(const Nodes& nodes, LeafValues& values);

} // namespace firetwin::volume
