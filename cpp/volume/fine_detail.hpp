#pragma once

#include "base/sparse_smoke.hpp"
#include "volume/ray.hpp"

#include <array>
#include <cstddef>

namespace firetwin::volume {

/// Values at consecutive samples of a ray (SIMD lanes).
using SampleRow = std::array<float, 16>;

/// Noise below the voxel along a ray within a block. It continues the octaves of the painted detail
/// (flow::Detail) down to some pixels, and travels with the air like those. Its coordinates are
/// linear along the ray, and continuous at the faces of blocks.
class FineDetail {
public:
  FineDetail() = default;
  /// @param from, to distances between which the ray is in the block, m
  FineDetail(const LayerCrossing& crossing, const Segment& segment, float from, float to);

  /// Returns whether there is an octave of at least `finest` m.
  bool shows(float finest) const { return frame_ != nullptr && frame_->size > finest; }
  /// Computes the noise, mean 0, in the unit of an outline's share. Octaves fade out towards the
  /// wavelength `finest`, m.
  void at(const SampleRow& distances, float finest, SampleRow& noise) const;

private:
  const NoiseFrame* frame_ = nullptr;
  float from_ = 0.0F;
  std::array<float, NoiseFrame::parts> start_{}, slope_{}; ///< m at `from_`, and per m
};

/// Smoke of a sample: a factor on its interpolated extinction, which sharpens outlines and adds
/// noise to them. The mean over an outline stays the same.
/// @param edge interpolated share inside the outline
/// @param sharpness steepness of the outline, relative to the painted one
float outline_factor(float edge, float noise, float sharpness);

} // namespace firetwin::volume
