#pragma once

#include "flow/detail.hpp"
#include "flow/detail_noise.hpp"
#include "flow/detail_output.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace firetwin::flow {

/// Paints the columns of a voxel region one after the other. Smooth quantities are computed for a
/// complete column; noise, the slowest part, for a full Row of voxels from several columns.
class Detail::Brush {
public:
  Brush(const Detail& detail, const VoxelRegion& brick, DetailOutput& out);

  void column(Index i, Index j);
  /// Paints the remaining queued voxels.
  void finish();

private:
  /// Voxels queued for noise.
  struct PendingVoxels {
    std::size_t count = 0;
    std::array<std::size_t, static_cast<std::size_t>(lanes)> place{}; ///< destination in the output
    Row share{}, above{}, amount{}, gain{}, reach{}, vigour{}, solid{};
    std::array<Origins, Drift::phases> origin{};
  };

  std::size_t place(std::size_t n) const { return out_.place(i_, j_, voxel_[n]); }
  bool move_to(Index i, Index j);
  bool find_levels();
  void find_heights();
  void find_voxels(Index i, Index j);
  void add_voxel(Index voxel, float height, std::size_t k, float way);
  void interpolate(const Columns& of, std::vector<float>& values);
  void find_amount();
  void find_drift();
  float moved(std::size_t part, std::size_t n) const;
  std::array<float, 2> meander(std::size_t n) const;
  float log_gain(std::size_t n) const;
  void paint_surface();
  void enqueue();
  void wait_for(std::size_t n);
  /// Values of `SparseSmoke` at a voxel.
  struct Painted {
    float extinction, edge, veil;
  };
  Painted paint(std::size_t n, float raise) const;

  const Detail& detail_;
  const VoxelRegion& brick_;
  DetailOutput& out_;

  // State of the current column:
  double x_ = 0.0, y_ = 0.0;                           ///< m
  std::size_t column_ = 0;                             ///< index in the region
  Index i_ = 0, j_ = 0;                                ///< its x and y
  ColumnStencil at_;                                   ///< in the flow's cells
  Index first_ = 0, last_ = 0;                         ///< levels with smoke
  Index low_ = 0, high_ = 0;                           ///< levels needed for interpolation
  std::vector<float> height_;                          ///< [nz] cell centres here, m
  std::vector<float> level_;                           ///< [1 + nz + 1] buffer of one quantity
  std::array<std::vector<float>, Drift::parts> drift_; ///< [nz] m

  // Voxels of the column that have smoke:
  LevelSamples places_;
  std::vector<Index> voxel_;           ///< z index
  std::vector<float> high_up_, above_; ///< elevation, and height above ground, m
  std::vector<float> amount_, gain_, vigour_, cloud_, reach_, solid_, value_;

  DetailNoise noise_;
  float outline_; ///< change of the noise across an outline
  PendingVoxels pending_;
};

} // namespace firetwin::flow
