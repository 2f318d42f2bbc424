#pragma once

#include "base/sparse_smoke.hpp"
#include "volume/grid_resampler.hpp"
#include "volume/sunlight.hpp"
#include "volume/voxel_grid.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace firetwin::volume {

/// Density of a block's voxels, of one more on each upper side, and of the surrounding voxels that
/// the light on them depends on.
struct Neighbourhood {
  static constexpr std::int64_t wide = SparseSmoke::side + 1;
  static constexpr std::int64_t reach = 4;
  static constexpr std::int64_t count = wide + 2 * reach;    ///< along x and y
  static constexpr std::int64_t row = 3 * SparseSmoke::side; ///< along z
  /// Padded: SIMD loads may read past the last row.
  std::array<float, count * count * row + 16> density{};

  const float* at(std::int64_t x, std::int64_t y) const {
    return density.data() + ((x + reach) * count + y + reach) * row + SparseSmoke::side;
  }
};

/// Light on the 9^3 voxels of a block and its upper sides, in rows of 16 along z.
struct BlockLight {
  static constexpr std::int64_t wide = Neighbourhood::wide;
  static constexpr std::int64_t row = 16;
  std::array<float, wide * wide * row> sun, sky;
};

/// Optical depths of smoke to its lights.
struct LightDepths {
  OwnedVoxelGrid sun; ///< on voxels of twice the size
  SkyDepths sky;      ///< on voxels of four times the size
};

/// Dims the glow of flames by the smoke below, as most flames are on the ground: by exp(-part *
/// optical depth), on voxels of twice the size. Smoke without a glow stays as it is.
void dim_glow(SparseSmoke& smoke, double part);

/// Sunlight and skylight in sparse smoke as transmittance exp(-factor * optical depth), 1 in clear
/// air. It is computed where the voxel or one of its 26 neighbours has smoke, as interpolation
/// needs; elsewhere it is 0.
///
/// Optical depth to the sun is computed on voxels of twice the size and interpolated linearly; the
/// first voxels along the ray are marched one by one. Skylight is computed on voxels of four times
/// the size. These coarse grids are dense; light at full resolution is computed block by block.
class LitSmoke {
public:
  /// @param direction unit vector to the sun
  /// @param beyond optical depths of a larger, coarser grid, added where a ray leaves this one; may
  /// be null
  /// @param factors on the optical depth, for sunlight and for skylight
  /// @throws std::invalid_argument
  LitSmoke(std::shared_ptr<const SparseSmoke> smoke, const Vector& direction,
           const LightDepths* beyond, std::array<double, 2> factors);

  const SparseSmoke& smoke() const { return *smoke_; }
  const std::shared_ptr<const LightDepths>& depths() const { return depths_; }
  void gather(const SparseSmoke::Place& block, Neighbourhood& out) const;
  /// Computes the light in a block. Returns false, and writes nothing, if there is no smoke near.
  bool light(const SparseSmoke::Place& block, const Neighbourhood& around, BlockLight& out) const;
  /// Writes the light into dense arrays, which must be 0 before.
  void write_dense(std::span<float> sun, std::span<float> sky) const;

private:
  /// Offsets in a Neighbourhood and weights of the sum along the first voxels of a ray, the same
  /// for all voxels.
  struct Stencil {
    std::vector<std::ptrdiff_t> offsets;
    std::vector<float> weights;
    SparseSmoke::Place low{}, high{}; ///< extent, voxels

    explicit Stencil(const Vector& direction);
  };

  void find_sun_depths(const SparseSmoke::Place& first, const float* own, float* out) const;

  std::shared_ptr<const SparseSmoke> smoke_;
  float log_attenuation_; ///< sunlight = exp(log_attenuation_ * optical depth)
  std::shared_ptr<const LightDepths> depths_;
  OwnedVoxelGrid sky_light_;
  Stencil first_steps_;
  std::optional<GridResampler> sky_, depth_,
      depth_beyond_; ///< depth_beyond_ starts at the end of the first steps
};

} // namespace firetwin::volume
