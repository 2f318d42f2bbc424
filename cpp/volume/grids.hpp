#pragma once

#include "archive.hpp"
#include "sight.hpp"
#include "smooth.hpp"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <vector>

/// What smoke grids have in common, whether they come from puffs or from a model's own fields.
namespace firetwin {

/// Smoke that counts as dilution 1, kg/m3: 10 mg/m3, as over a crown fire.
constexpr double kFreshSmoke = 1.0e-5;

/// Thinner smoke than this times kFreshSmoke is left out.
constexpr double kThinnest = 2.0e-3;

constexpr float kEdgeLow = 0.46F; // density where `shade` begins and where it is whole
constexpr float kEdgeHigh = 0.55F;
constexpr float kHottest = 1500.0F; // K

inline float smoothstep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

/// International Standard Atmosphere at a height (m), K.
inline float air_kelvin(float height) {
  return 288.15F - 0.0065F * height;
}

/// Centre of the lowest voxel, m.
std::array<float, 3> corner_of(const openvdb::Coord& origin, float voxel_size);

enum class SmokeGrid { density, dilution, shade, size, temperature, glow, flame };

/// @throws Error for a name that is not one of them.
SmokeGrid smoke_grid(const std::string& name);

/// What is to be written of the smoke of a moment.
struct Wanted {
  std::vector<SmokeGrid> grids; // none: all; glow and flame only with flames
  Flames flames;
  Sight sight;
  Metadata metadata;
};

/// Smoke leaf by leaf.
struct LeafSource {
  SharedLeaves leaves;
  std::string density_units;
  /// Values of a leaf in one grid; not asked for glow and flame.
  std::function<void(std::size_t leaf, SmokeGrid grid, LeafValues& out)> values;
};

/// Writes the wanted grids of the leaves that count (with 300 m round them). The frame's mass is
/// that of the dilution written, `hidden` that of the leaves left out.
VolumeFrame write_leaves(const std::string& path, const LeafSource& source, double voxel_size,
                         const Wanted& wanted);

/// Integral over active voxels.
double mass_of(const LeafMask& mask, const LeafValues& values, double voxel_size);

} // namespace firetwin
