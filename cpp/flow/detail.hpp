#pragma once

#include "base/sparse_smoke.hpp"
#include "base/vector.hpp"
#include "flow/columns.hpp"
#include "flow/drift.hpp"
#include "flow/filters.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::flow {

/// Smoke of a moment on a flow's cells, or on a block of them that reaches down to the ground.
struct Moment {
  Shape shape;
  double spacing;                 ///< m
  std::array<double, 2> corner;   ///< of the lowest x and y, m
  std::span<const double> levels; ///< [nz] of cells' middles above ground, m
  std::span<const float> heights; ///< [nz][ny][nx] the same in the ground's datum, m
  std::span<const float> ground;  ///< [ny][nx] m
  std::span<const float> smoke;   ///< [nz][ny][nx] kg/m3
  std::span<const float> age;     ///< s
  std::span<const float> rise;    ///< m/s
  std::span<const float> warmth;  ///< K above the air around
  std::span<const float> glow;    ///< light of flames, anything, or empty
  std::span<const float> drift;   ///< [nz][ny][nx][Drift::parts] m
  std::array<float, Drift::phases> weights{};
  std::array<std::int64_t, Drift::phases> turns{};
};

/// How smoke looks below the flow's cells.
struct Look {
  double size = 340.0;                      ///< of the largest lumps, m
  float scale = 1.0F;                       ///< of the fire, over the one all this is chosen for
  std::array<double, 3> blur{};             ///< of the drift along levels, rows and columns, cells
  double opacity = 1.0;                     ///< times the extinction of smoke
  float thickest = 0.03F;                   ///< extinction at which thick smoke levels off, 1/m
  std::array<float, 2> ages{20.0F, 600.0F}; ///< s, of dark and of white smoke
  float condensation = 1.0e6F;              ///< height from which vapour condenses, m
  std::uint32_t seed = 0;
};

/// Voxels to be painted, x slowest and z fastest.
struct Brick {
  Vector origin;                  ///< centre of the first, m
  double voxel;                   ///< m
  std::array<Index, 3> shape;     ///< along x, y, z
  std::span<const float> surface; ///< [nx][ny] height of the true ground, m
  std::span<const float> share;   ///< [nx][ny] factor of the extinction, 0 to 1
  /// Which blocks of `block` voxels along each side are wanted, in the voxels' order; empty: all.
  std::span<const std::uint8_t> wanted;

  static constexpr Index block = 16;
  std::array<Index, 3> blocks() const {
    return {(shape[0] + block - 1) / block, (shape[1] + block - 1) / block,
            (shape[2] + block - 1) / block};
  }
};

/// Detail below the cells of a flow: the logarithm of its smoke is raised and lowered by noise that
/// travels with the air, and what falls below a threshold is cut away. Vigorous smoke, which rises,
/// is warm, fresh or dense, gets lumps with crisp edges (Worley's noise); the rest gets soft veils
/// (Perlin's). Lumps have a size in metres: the noise's amplitude follows the slope of the
/// logarithm, up to what would tear thin smoke to pieces. The flow's own extinction is 4 m2/g
/// (fresh biomass smoke, Reid et al. 2005, doi 10.5194/acp-5-799-2005) times a gain chosen by eye;
/// near the ground it is less, so that flames show. Above the height where vapour condenses
/// vigorous smoke is white and a few times as thick, for water droplets. Thresholds and gains are
/// chosen by eye, on cells of 200 m. A smaller fire has thresholds alike in optical depth: its
/// lengths go with `Look::scale`, its densities with the inverse, its times and speeds as those of
/// eddies, with the powers 2/3 and 1/3.
class Detail {
public:
  Detail(const Moment& moment, const Look& look);

  /// Smoke of voxels; what is thinner than `thinnest` (1/m) is clear. It has a glow where the
  /// moment has one.
  SparseSmoke paint(const Brick& brick, float thinnest) const;
  bool glows() const { return !glow_.empty(); }

private:
  class Brush;
  static constexpr float unit = 1.0e-9F;        // kg/m3, over the scale
  static constexpr float least = 1.2F;          // amount without any smoke to see
  static constexpr std::array core{6.3F, 8.0F}; // of a vigorous core at least, thin and thick
  static constexpr float cloud_amount = 2.5F;   // of droplets in the amount
  static constexpr float terrain_fade =
      1000.0F; // m, times the scale, over which levels forget finer ground

  using Values = std::vector<float>; ///< [nz][ny][nx]
  void find_vigour(const Moment& moment, const Values& amount);
  void find_reach(const Moment& moment, const Values& amount);
  void find_drift(const Moment& moment);
  float capped(float height) const;
  bool shows(std::size_t phase) const { return weights_[phase] > 0.02F; }

  Shape shape_;
  double spacing_;
  std::array<double, 2> corner_;
  std::vector<float> levels_;
  std::vector<float> sinking_; ///< [nz] how much of finer ground than the flow's a level follows
  Columns heights_;            ///< m
  Columns ground_;             ///< of one level, m
  Columns amount_;             ///< ln(smoke / unit), at least 0
  Columns vigour_;             ///< 0 to 1
  Columns reach_;              ///< of crisp noise in the amount
  Columns solid_;              ///< 0 where smoke is thin all round, 1 where it is thick
  Columns age_, glow_;
  std::array<Columns, Drift::parts> drift_; ///< of the phases that show
  std::array<float, Drift::phases> weights_;
  std::array<std::uint32_t, Drift::phases> seeds_{};
  Look look_;
  float unit_; ///< kg/m3
};

} // namespace firetwin::flow
