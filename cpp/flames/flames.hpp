#pragma once

#include "flames/field.hpp"
#include "flames/table.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace firetwin::flames {

/// Light and heat of flames, by heat from 0 (coolest) to 1 (hottest).
struct FlameLight {
  std::vector<std::array<float, 3>> visible; ///< radiance at evenly spaced heats
  std::array<float, 3> soot_light;           ///< radiance of soot per unit of optical depth
  float soot;              ///< extinction of cooled soot over the flames, over a flame's
  double coolest, hottest; ///< temperatures at heat 0 and 1, K
  /// Flame length (m), visible and infrared extinction (1/m); linear between rows.
  std::vector<std::array<float, 3>> extinction;
  float dim; ///< optical depth of 1 km of air in the infrared; it grows with distance^0.75
};

/// Resolution and range of a camera.
struct FlameView {
  float pixel;               ///< size of a pixel per distance, m/m
  std::array<float, 2> fade; ///< distances between which the flames fade out, m

  /// Share of the flames, 0 to 1, that is drawn at a distance, m: none at the lens and beyond
  /// `fade`.
  float share(float away) const;
};

/// Extinction, light and temperature of flames in a step.
struct FlameStep {
  float extinction = 0.0F;          ///< of flames and soot, 1/m
  std::array<float, 3> radiance{};  ///< of what extinguishes
  float flames = 0.0F, heat = 0.0F; ///< extinction of flames alone, 1/m, and their mean heat
  float infrared = 0.0F;            ///< extinction, 1/m
};

/// Flames of one frame, as a volume.
class FlameVolume {
public:
  FlameVolume(const FlamePatches& patches, std::span<const Spindle> crowns,
              std::shared_ptr<const FlameLibrary> library, const FlameShape& shape,
              const FlameLight& light, const FlameView& view, const Vector& origin, double time);
  FlameVolume(const FlameVolume&) = delete;
  FlameVolume& operator=(const FlameVolume&) = delete;

  const FlameField& field() const { return field_; }
  const FlameTiles& tiles() const { return tiles_; }
  const FlameLight& light() const { return light_; }
  const FlameView& view() const { return view_; }
  const Vector& origin() const { return origin_; }

  /// Computes a step that ends at a lane.
  /// @param before codes of each kind of gas at its start
  FlameStep step(const FlameSamples::Codes& before, const FlameSamples& samples,
                 std::size_t lane) const;

private:
  std::array<float, 2> extinction(float length, float drawn, float share) const;

  std::shared_ptr<const FlameLibrary> library_;
  Vector origin_;
  FlameLight light_;
  FlameView view_;
  FlameTable table_;
  FlameCrowns crowns_;
  FlameTiles tiles_;
  FlameField field_;
};

/// Transmittance at which a ray ends in flames.
inline constexpr float opaque_flames = 0.01F;

/// Flames within eight steps of a ray.
struct FlameSlab {
  float from, to;                ///< m from the ray's origin
  std::array<float, 3> radiance; ///< that leaves towards the eye
  float transmittance;
  float infrared, infrared_transmittance; ///< if a table of radiance is given
  float share;                            ///< of the steps that are in flames
  std::array<float, lane_count> red;      ///< radiance of the steps up to each
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

  /// Finds the next slab with flames that begins before `begin` (m), and ends at `end` at the
  /// latest. False if there is none.
  bool next(float begin, float end, FlameSlab& slab);

private:
  float step_at(const FlameTiles::Tile& tile, float height, float limit) const;
  void fill(float from, float step, FlameSlab& slab);

  const FlameVolume& flames_;
  const BandRadiance* band_;
  std::array<float, 3> start_, direction_;
  float at_, end_;
  FlameSamples::Codes before_{}; ///< at the end of the last slab
  float before_at_ = -1.0F;      ///< m
  float lowest_ = 0.0F;          ///< height of the lowest flames in the last slab, m
};

} // namespace firetwin::flames
