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

  /// Writes the profiles as float32: the heat that leaves the box over the air's density, specific
  /// heat and temperature, per time and length along y; the mean speed at which burning gas rises
  /// (nz); and the largest error of the divergence times a cell.
  void close();

private:
  void add_profiles(const Flame& flame);

  std::string path_;
  std::ofstream frames_;
  int count_ = 0;
  std::vector<std::uint8_t> codes_;
  std::vector<double> rise_, hot_cells_;
  Settings settings_;
  double heat_ = 0.0;
  float divergence_ = 0.0F;
};

} // namespace flame_solver
