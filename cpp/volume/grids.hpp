#pragma once

#include "archive.hpp"
#include "smooth.hpp"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
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

/// density, dilution, shade, size, temperature and, when lit, glow.
std::vector<GridName> smoke_grids(bool lit, const std::string& density_units);

/// Integral over active voxels.
double mass_of(const LeafMask& mask, const LeafValues& values, double voxel_size);

/// Glow of flames in a leaf, see write_smoke.
void glow(const openvdb::Coord& origin, float voxel_size, const Flames& flames, LeafValues& out);

/// Power of the flames within 1.5 voxels in GW, at most 1.
openvdb::FloatGrid::Ptr flame_grid(const Flames& flames, double voxel_size);

} // namespace firetwin
