#pragma once

#include "flow/drift.hpp"
#include "flow/noise.hpp"

#include <array>
#include <cstdint>

namespace firetwin::flow {

/// Advected coordinates (place - drift) of a row of voxels, m: east, north and up.
using Origins = std::array<std::array<double, static_cast<std::size_t>(lanes)>, 3>;

/// Fractal noise of smoke detail: octaves of Worley noise (billows) where smoke is vigorous, of
/// Perlin noise (veils) elsewhere.
class DetailNoise {
public:
  /// @param size wavelength of the largest octave, m
  /// @param voxel voxel size, m; octaves that it does not resolve are left out
  /// @param seeds of each phase's noise
  DetailNoise(double size, double voxel, const std::array<std::uint32_t, Drift::phases>& seeds);

  /// Computes the noise of a phase; `vigour`, 0 to 1, blends from veils to billows.
  void at(const Origins& places, std::size_t phase, const Row& vigour, Row& noise);

  /// Change of the noise of billows across an outline: smoke fades over some voxels, since a
  /// sharper outline draws the lattice.
  float outline() const;
  /// Wavelength (m) and amplitude of the largest octave that is not painted.
  std::array<double, 2> finer_octave() const;

private:
  static constexpr int billow_octaves = 3, max_octaves = 7;

  /// Returns whether voxels resolve an octave.
  bool paints(int octave, double size) const;

  double size_, voxel_;
  std::array<std::uint32_t, Drift::phases> seeds_;
  std::array<std::array<Worley, billow_octaves>, Drift::phases> worley_;
};

} // namespace firetwin::flow
