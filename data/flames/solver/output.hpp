#pragma once

#include "flame.hpp"

#include <cstdint>
#include <fstream>
#include <string>

namespace flame_solver {

/// Writes frames of codes, and mean profiles of the flow over the stored frames.
class Output {
public:
  explicit Output(const Settings& settings);
  void add(const Flame& flame);

  /// Writes the profiles as float32: the gas that expands below the top of each level, per time and
  /// length along y (nz), which is the convected heat over the air's density, specific heat and
  /// temperature; the mean speed at which burning gas rises (nz); and the largest error of the
  /// divergence times a cell.
  void close();

private:
  void add_profiles(const Flame& flame);

  std::string path_;
  std::ofstream frames_;
  int count_ = 0;
  std::vector<std::uint8_t> codes_;
  std::vector<double> heat_, rise_, hot_cells_;
  Settings settings_;
  float divergence_ = 0.0F;
};

} // namespace flame_solver
