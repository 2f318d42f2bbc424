#pragma once

#include "geo/local_frame.hpp"
#include "volume/grids.hpp"

#include <filesystem>
#include <limits>
#include <span>

namespace firetwin::volume {

/// Model smoke at one time on terrain-following levels [nz ny nx], with ascending heights.
struct Levels {
  std::span<const double> latitude;   ///< [ny] degrees
  std::span<const double> longitude;  ///< [nx]
  std::span<const float> ground;      ///< [ny nx] m, elevation
  std::span<const float> height;      ///< m
  std::span<const float> smoke;       ///< kg/m3; negative and non-finite values count as 0
  std::span<const float> temperature; ///< K; empty: International Standard Atmosphere
  std::size_t levels = 0;
};

/// Replaces invalid smoke densities (NaN, infinity, negative) by 0.
inline float valid_smoke(float smoke) {
  return smoke > 0.0F && smoke <= std::numeric_limits<float>::max() ? smoke : 0.0F;
}

/// Resamples a model's smoke to a regular voxel grid in the local frame, and writes its grids.
///
/// At a voxel's latitude and longitude (exact at the corners of each 8^3 leaf, trilinear inside,
/// with errors of centimetres), fields and level heights are bilinear, and the field is linear in
/// height between levels. Linear functions of height are reproduced exactly. Below the lowest
/// level, its value is constant down to the ground. Above the highest level, outside the grid and
/// below the ground there is no smoke. The result is not rescaled: VdbSummary::mass is its
/// integral.
///
/// A model has no smoke surface, so one is derived from concentration: `density` is a smoothstep of
/// `dilution` from min_dilution to 0.1. `size` is the
/// spacing of the model's columns, below which only noise adds detail.
/// @throws std::invalid_argument for an invalid voxel size; Error if heights do not ascend
VdbSummary write_levels(const std::filesystem::path& path, const geo::LocalFrame& frame,
                        const Levels& levels, double voxel_size, const GridRequest& wanted);

} // namespace firetwin::volume
