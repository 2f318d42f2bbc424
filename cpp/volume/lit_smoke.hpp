#pragma once

#include "base/sparse_smoke.hpp"
#include "volume/grid_resampler.hpp"
#include "volume/voxel_grid.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace firetwin::volume {

/// Density of a block's voxels, of one more on each of its high sides, and of so many round them
/// that the light on them depends on.
struct Neighbourhood {
  static constexpr std::int64_t wide = SparseSmoke::side + 1;
  static constexpr std::int64_t reach = 4;
  static constexpr std::int64_t count = wide + 2 * reach;    ///< along x and y
  static constexpr std::int64_t row = 3 * SparseSmoke::side; ///< along z
  /// Vectors may reach beyond the last row.
  std::array<float, count * count * row + 16> density{};

  const float* at(std::int64_t x, std::int64_t y) const {
    return density.data() + ((x + reach) * count + y + reach) * row + SparseSmoke::side;
  }
};

/// Light on the 9^3 voxels of a block and its high sides, in rows of 16 along z.
struct BlockLight {
  static constexpr std::int64_t wide = Neighbourhood::wide;
  static constexpr std::int64_t row = 16;
  std::array<float, wide * wide * row> sun, sky;
};

/// Sunlight and skylight in sparse smoke: exp(-part of the optical depth), 1 where it is clear;
/// only where there is smoke in the voxel or one of the 26 around it, which is all that is needed
/// to interpolate it: elsewhere it is 0.
///
/// Optical depth to the sun is found on voxels of twice the size, and linear between them; the
/// first voxels of the way are marched one by one. The sky's light is found on voxels of four times
/// the size. These are dense arrays; what is as fine as the smoke is found block by block.
class LitSmoke {
public:
  /// @param direction unit vector that the sun's light comes from
  /// @param beyond optical depths of a larger brick, counted where a way leaves this one; may be
  ///   null
  /// @param parts of the optical depth that count, for the sun and for the sky
  /// @throws std::invalid_argument
  LitSmoke(std::shared_ptr<const SparseSmoke> smoke, const Vector& direction,
           const VoxelGrid* beyond, std::array<double, 2> parts);

  const SparseSmoke& smoke() const { return *smoke_; }
  /// Optical depths to the sun, on voxels of twice the size.
  const OwnedVoxelGrid& depths() const { return depths_; }
  void gather(const SparseSmoke::Place& block, Neighbourhood& out) const;
  /// Light in a block. False where there is no smoke near, and nothing is written.
  bool light(const SparseSmoke::Place& block, const Neighbourhood& around, BlockLight& out) const;
  /// Light as dense arrays of zeros are given it.
  void spread(std::span<float> sun, std::span<float> sky) const;

private:
  /// What is summed round a voxel, the same round each: places in a Neighbourhood, and weights.
  struct Stencil {
    std::vector<std::ptrdiff_t> offsets;
    std::vector<float> weights;
    SparseSmoke::Place low{}, high{}; ///< how far it reaches, voxels

    explicit Stencil(const Vector& direction);
  };

  void find_sun(const SparseSmoke::Place& first, const float* own, float* out) const;

  std::shared_ptr<const SparseSmoke> smoke_;
  float thinner_; ///< than nothing is the light, for each optical depth
  OwnedVoxelGrid depths_, open_;
  Stencil first_steps_;
  std::optional<GridResampler> sky_, depth_,
      depth_beyond_; ///< the last from the end of the first steps
};

} // namespace firetwin::volume
