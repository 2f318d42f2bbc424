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
  /// wavelength `finest` (m) of each sample.
  void at(const SampleRow& distances, const SampleRow& finest, SampleRow& noise) const;

private:
  const NoiseFrame* frame_ = nullptr;
  float from_ = 0.0F;
  std::array<float, NoiseFrame::parts> start_{}, slope_{}; ///< m at `from_`, and per m
};

/// Outline of the smoke at a sample, interpolated between voxels.
///
/// The share of voxels inside an outline is clamped, so that its surface of one half follows the
/// lattice. Their position is not, and its surface of one half is smooth.
struct Outline {
  float share;    ///< inside the outline, 0 to 1
  float position; ///< in the outline: 1 on its outer side, 2 on its inner side
  float veil;     ///< extinction without an outline, 1/m

  /// Returns the extinction with a sharp outline and noise. The mean over an outline stays about
  /// the same.
  /// @param density interpolated extinction, 1/m
  /// @param sharpness steepness of the outline, relative to the painted one
  /// @param part share of this change, 0 to 1
  float extinction(float density, float noise, float sharpness, float part) const;
};

} // namespace firetwin::volume
