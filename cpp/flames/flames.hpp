#pragma once

#include "flames/field.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::flames {

/// Light and heat of flames, by heat from 0 (coolest) to 1 (hottest).
struct FlameLight {
  std::vector<std::array<float, 3>> visible; ///< radiance at evenly spaced heats
  float extinction;                          ///< 1/m
  float soot;                                ///< extinction of cooled soot over the flames, 1/m
  std::array<float, 3> soot_light;           ///< radiance of soot per unit of optical depth
  double coolest, hottest;                   ///< temperatures at heat 0 and 1, K
  /// Flame length (m), and factors on the visible and the infrared extinction; linear between rows.
  std::vector<std::array<float, 3>> scales;
  float infrared; ///< infrared extinction, 1/m
  float dim;      ///< optical depth of 1 km of air in the infrared; it grows with distance^0.75
};

/// Resolution and range of a camera.
struct FlameView {
  float pixel;               ///< size of a pixel per distance, m/m
  std::array<float, 2> fade; ///< distances between which the flames fade out, m

  /// Share of the flames, 0 to 1, that is drawn at a distance, m: none at the lens and beyond
  /// `fade`.
  float share(float away) const;
};

/// Flames of one frame, as a volume.
class FlameVolume {
public:
  FlameVolume(std::span<const FlameSquare> squares, std::span<const Spindle> spindles,
              const FlameShape& shape, const FlameLight& light, const FlameView& view,
              const Vector& origin, double time);
  FlameVolume(const FlameVolume&) = delete;
  FlameVolume& operator=(const FlameVolume&) = delete;

  const FlameField& field() const { return field_; }
  const FlameTiles& tiles() const { return tiles_; }
  const FlameLight& light() const { return light_; }
  const FlameView& view() const { return view_; }
  const Vector& origin() const { return origin_; }
  /// Factors on the visible and the infrared extinction at a flame length, m.
  std::array<float, 2> scale(float length) const;

private:
  Vector origin_;
  FlameLight light_;
  FlameView view_;
  FlameTiles tiles_;
  FlameField field_;
};

/// Flames within eight steps of a ray.
struct FlameSlab {
  float from, to;                ///< m from the ray's origin
  std::array<float, 3> radiance; ///< that leaves towards the eye
  float transmittance;
  float infrared, infrared_transmittance; ///< if a table of radiance is given
  float share;                            ///< of the steps that are in flames
};

/// Black-body radiance in a band at evenly spaced temperatures.
struct BandRadiance {
  std::span<const float> radiance;
  double coldest, step; ///< K
  float at(float kelvin) const;
};

/// Marches flames along a ray from slab to slab. Use one object per ray.
class FlameRay {
public:
  FlameRay(const FlameVolume& flames, const Vector& origin, const Vector& direction, float end,
           const BandRadiance* band = nullptr);

  /// Finds the next slab with flames that begins before `limit` (m), and ends no later. False if
  /// there is none.
  bool next(float limit, FlameSlab& slab);

private:
  void fill(float from, float step, FlameSlab& slab) const;

  const FlameVolume& flames_;
  const BandRadiance* band_;
  std::array<float, 3> start_, direction_;
  float at_, end_;
};

} // namespace firetwin::flames
