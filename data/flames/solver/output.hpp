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

  /// Writes the profiles as float32: means over time and y of temperature and of w, (nz, nx) each;
  /// the heat that rises through each level (nz); the mean speed at which hot gas rises (nz); and
  /// the largest error of the divergence.
  void close();

private:
  void add_profiles(const Flame& flame);

  std::string path_;
  std::ofstream frames_;
  int count_ = 0;
  std::vector<std::uint8_t> codes_;
  std::vector<double> temperature_, speed_, heat_, rise_, hot_cells_;
  Settings settings_;
  float divergence_ = 0.0F;
};

} // namespace flame_solver
