#pragma once

#include "flow/detail.hpp"
#include "flow/detail_noise.hpp"
#include "flow/detail_output.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace firetwin::flow {

/// Paints a brick's columns, one after the other. What varies smoothly is found for a whole column;
/// noise, which takes the longest, for as many voxels at once as make a Row, whatever their
/// columns.
class Detail::Brush {
public:
  Brush(const Detail& detail, const VoxelRegion& brick, DetailOutput& out);

  void column(Index i, Index j);
  /// Paints what still waits for others.
  void finish();

private:
  /// Voxels whose noise is to be found.
  struct Waiting {
    std::size_t count = 0;
    std::array<std::size_t, static_cast<std::size_t>(lanes)> place{}; ///< where it is painted
    Row share{}, above{}, amount{}, reach{}, vigour{}, solid{};
    std::array<Origins, Drift::phases> origin{};
  };

  std::size_t place(std::size_t n) const { return out_.place(i_, j_, voxel_[n]); }
  bool stand(Index i, Index j);
  bool find_levels();
  void find_heights();
  void find_voxels(Index i, Index j);
  void add_voxel(Index voxel, float height, std::size_t k, float way);
  void find(const Columns& of, std::vector<float>& values);
  void find_amount();
  void paint_surface();
  void wait();
  void wait_for(std::size_t n);
  float extinction(std::size_t n, float raise) const;

  const Detail& detail_;
  const VoxelRegion& brick_;
  DetailOutput& out_;

  // Of a column.
  double x_ = 0.0, y_ = 0.0;   ///< m
  std::size_t column_ = 0;     ///< in the brick
  Index i_ = 0, j_ = 0;        ///< the same along x and y
  ColumnStencil at_;           ///< in the flow
  Index first_ = 0, last_ = 0; ///< levels with smoke
  Index low_ = 0, high_ = 0;   ///< levels that values between them are found from
  std::vector<float> height_;  ///< [nz] of cells' middles here, m
  std::vector<float> level_;   ///< [1 + nz + 1] of what is being found
  std::array<std::vector<float>, Drift::parts> drift_; ///< [nz] m

  // Of the column's voxels with smoke.
  LevelSamples places_;
  std::vector<Index> voxel_;           ///< from the brick's bottom up
  std::vector<float> high_up_, above_; ///< m in the ground's datum, and over the ground
  std::vector<float> amount_, vigour_, cloud_, reach_, solid_, value_;

  DetailNoise noise_;
  Waiting waiting_;
};

} // namespace firetwin::flow
