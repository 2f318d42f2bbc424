#pragma once

#include "geo/local_frame.hpp"
#include "volume/grids.hpp"

#include <filesystem>
#include <limits>
#include <span>

namespace firetwin::volume {

/// Model smoke at one time on terrain-following levels [nz ny nx], heights ascending.
struct Levels {
  std::span<const double> latitude;   ///< [ny] degrees
  std::span<const double> longitude;  ///< [nx]
  std::span<const float> ground;      ///< [ny nx] m, elevation
  std::span<const float> height;      ///< m
  std::span<const float> smoke;       ///< kg/m3; what is not a number or negative counts as 0
  std::span<const float> temperature; ///< K; empty: of the International Standard Atmosphere
  std::size_t levels = 0;
};

/// Valid smoke density: NaN, infinity and negative values become 0.
inline float valid_smoke(float smoke) {
  return smoke > 0.0F && smoke <= std::numeric_limits<float>::max() ? smoke : 0.0F;
}

/// Writes a model's smoke on a regular grid of voxels in the local frame, with the grids of
/// write_smoke.
///
/// At a voxel's latitude and longitude (exact at the corners of each 8^3 leaf, trilinear inside:
/// centimetres) fields and heights of the levels are bilinear, and the field is linear in height
/// between levels: linear functions of height are kept exactly. Below the lowest level its value
/// holds down to the ground; above the highest, outside the grid and under the ground there is no
/// smoke. Nothing is scaled: VdbSummary::mass is the integral of what was found.
///
/// The model gives no surface, so one is made of its concentration: `density` is a smoothstep of
/// `dilution` from thinnest_dilution to 0.1, thick in every voxel, `shade` follows from both as in
/// write_smoke, and `size` is the spacing of the model's columns, below which only noise can show
/// detail.
/// @throws std::invalid_argument unless check_voxel_size passes; Error where heights do not ascend
VdbSummary write_levels(const std::filesystem::path& path, const geo::LocalFrame& frame,
                        const Levels& levels, double voxel_size, const GridRequest& wanted);

} // namespace firetwin::volume
