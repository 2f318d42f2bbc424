#pragma once

#include "base/sparse_smoke.hpp"
#include "base/vector.hpp"
#include "flow/columns.hpp"
#include "flow/detail_noise.hpp"
#include "flow/drift.hpp"
#include "flow/filters.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace firetwin::flow {

/// Smoke of a flow at one time, on all cells or on a block of cells that reaches down to the
/// ground.
struct SmokeSnapshot {
  Shape shape;
  double spacing;                            ///< m
  std::array<double, 2> corner;              ///< south-west corner, m
  std::span<const double> levels;            ///< [nz] heights of cell centres above ground, m
  std::span<const float> heights;            ///< [nz][ny][nx] elevation of cell centres, m
  std::span<const float> ground;             ///< [ny][nx] m
  std::span<const float> smoke;              ///< [nz][ny][nx] kg/m3
  std::span<const float> age;                ///< s
  std::span<const float> rise;               ///< m/s
  std::span<const float> temperature_excess; ///< K above the ambient air
  std::span<const float> glow;               ///< light of flames in any unit; empty: no flames
  std::span<const float> drift;              ///< [nz][ny][nx][Drift::parts] m
  std::array<float, Drift::phases> weights{};
  std::array<std::int64_t, Drift::phases> turns{};
};

/// Settings of the procedural smoke detail.
struct DetailSettings {
  double size = 340.0;          ///< diameter of the largest billows, m
  float scale = 1.0F;           ///< scale of the fire over that on 200 m cells
  std::array<double, 3> blur{}; ///< Gaussian blur of the drift along levels, rows, columns, cells
  double opacity = 1.0;         ///< factor on the extinction
  float max_extinction = 0.03F; ///< extinction at which thick smoke levels off, 1/m
  std::array<float, 2> ages{20.0F,
                            600.0F};  ///< ages between which smoke turns from dark to white, s
  float condensation_height = 1.0e6F; ///< elevation above which vapour condenses, m
  std::uint32_t seed = 0;
};

/// Region of voxels to compute, x slowest and z fastest.
struct VoxelRegion {
  Vector origin;                  ///< centre of the first voxel, m
  double voxel;                   ///< m
  std::array<Index, 3> shape;     ///< along x, y, z
  std::span<const float> surface; ///< [nx][ny] elevation of the true terrain, m
  std::span<const float> share;   ///< [nx][ny] factor on the extinction, 0 to 1
  /// Mask of blocks of `block` voxels along each side to compute, in the voxels' order; empty: all.
  std::span<const std::uint8_t> wanted;
  /// [nx][ny] logarithm of a factor on smoke near the ground, where sources finer than cells place
  /// it; empty: 0.
  std::span<const float> log_gain;
  std::array<float, 2> lean{}; ///< horizontal shift of `log_gain` over the height above ground
  float gain_height = 250.0F;  ///< height to which `log_gain` reaches, m

  static constexpr Index block = 16;
  std::array<Index, 3> blocks() const {
    return {(shape[0] + block - 1) / block, (shape[1] + block - 1) / block,
            (shape[2] + block - 1) / block};
  }
};

/// Procedural smoke detail below the cells of a flow. Advected noise (drift.hpp) changes the
/// logarithm of the smoke, and a threshold removes thin smoke.
///
/// - Vigorous smoke (rising, warm, fresh or dense) has billows with crisp edges (Worley noise).
///   Other smoke has soft veils (Perlin noise).
/// - Billows have a size in metres: the amplitude of the noise follows the gradient of the
///   logarithm, up to a limit that keeps thin smoke connected.
/// - Extinction is 4 m2/g (fresh biomass smoke, Reid et al. 2005, doi 10.5194/acp-5-799-2005) times
///   a gain chosen by eye. It is reduced near the ground, so that flames are visible.
/// - Above the condensation height vigorous smoke is white and several times as thick (droplets).
///
/// Thresholds and gains are chosen by eye, on cells of 200 m. A smaller fire has the same optical
/// depths: lengths scale with `DetailSettings::scale`, densities with its inverse, times with its
/// power 2/3 and speeds with its power 1/3, like turbulent eddies.
class Detail {
public:
  Detail(const SmokeSnapshot& snapshot, const DetailSettings& settings);

  /// Computes the smoke of a region of voxels. Smoke with an extinction below `min_extinction`
  /// (1/m) is set to clear. The result has a glow if the snapshot has one.
  SparseSmoke paint(const VoxelRegion& brick, float min_extinction) const;
  bool glows() const { return !glow_.empty(); }

private:
  class Brush;
  static constexpr float unit = 1.0e-9F;        // kg/m3, divided by the scale
  static constexpr float visible_amount = 1.2F; // amount at which smoke becomes visible
  static constexpr std::array core{6.3F, 8.0F}; // least amount in a vigorous core, thin and thick
  static constexpr float cloud_amount = 2.5F;   // added to the amount by droplets
  static constexpr float terrain_fade =
      1000.0F; // m, times the scale: e-folding height of terrain detail in the levels

  using Values = std::vector<float>; ///< [nz][ny][nx]
  void find_vigour(const SmokeSnapshot& snapshot, const Values& amount);
  void find_reach(const SmokeSnapshot& snapshot, const Values& amount);
  void find_drift(const SmokeSnapshot& snapshot);
  float condensed_share(float height) const;
  /// Coordinates of the noise below the voxel at the corners of blocks.
  std::shared_ptr<const NoiseFrame> find_noise(const VoxelRegion& brick,
                                               const std::array<Index, 3>& blocks) const;
  bool shows(std::size_t phase) const { return weights_[phase] > 0.02F; }

  Shape shape_;
  double spacing_;
  std::array<double, 2> corner_;
  std::vector<float> levels_;
  std::vector<float>
      terrain_share_; ///< [nz] share of the terrain detail finer than cells that a level follows
  Columns heights_;   ///< m
  Columns ground_;    ///< m, one level
  Columns amount_;    ///< ln(smoke / unit), at least 0
  Columns vigour_;    ///< 0 to 1
  Columns reach_;     ///< amplitude of crisp noise
  Columns solid_;     ///< 0 in thin surroundings, 1 in thick smoke
  Columns age_, glow_;
  std::array<Columns, Drift::parts> drift_; ///< of the phases with nonzero weight
  std::array<float, Drift::phases> weights_;
  std::array<std::uint32_t, Drift::phases> seeds_{};
  DetailSettings settings_;
  float unit_; ///< kg/m3
};

} // namespace firetwin::flow
