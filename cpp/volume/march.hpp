#pragma once

#include "flames/flames.hpp"
#include "volume/ray.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace firetwin::volume {

using Colour = std::array<float, 3>; ///< linear red, green and blue

/// Light sources and scattering properties of smoke, and haze.
struct Illumination {
  float density;                            ///< factor on the extinction
  Colour fresh, old;                        ///< albedo of young and of old smoke
  Colour sun;                               ///< irradiance
  Colour sky;                               ///< mean radiance over all directions
  Vector sun_direction;                     ///< unit vector to the sun
  double anisotropy;                        ///< g of Henyey and Greenstein
  std::array<float, 2> multiple_scattering; ///< weights of light scattered two and three times,
                                            ///< relative to single scattering
  Colour glow;         ///< radiance of white smoke where `glow` is 1; black: no glow
  float thin;          ///< share of the glow that smoke without other smoke around it scatters
  Colour air, horizon; ///< radiance of thin and of thick haze
  std::array<float, 2> thick_haze;   ///< optical depths between which haze takes the second
  std::array<double, 2> haze;        ///< extinction of two layers of haze at height 0, 1/m
  std::array<double, 2> haze_height; ///< their e-folding heights, m
};

/// Distances along rays at which the result is returned.
struct Taps {
  std::span<const float>
      distances; ///< (n, count) m in any order; beyond all smoke: the final result
  std::size_t count;
};

struct MarchSettings {
  double step = 0.5; ///< voxels of the finest layer at each point
  /// Transmittance at which a ray ends; the remaining radiance is extrapolated.
  double min_transmittance = 1.0e-3;
  /// Width of a pixel at distance 0 (m), and its increase per m of distance. Outlines of smoke are
  /// as sharp as pixels show, and have noise below the voxel down to some pixels. Zeros: neither.
  std::array<double, 2> pixel{};
  bool parts = false; ///< return the light of flames, and the transmittance of smoke alone, too
};

/// Returns the number of values of each tap.
constexpr std::size_t march_values(bool parts) {
  return parts ? 8 : 4;
}

/// Marches rays through sparse smoke and flames: radiance and transmittance of each ray up to each
/// tap, (n, count, 4) red, green, blue and transmittance. With `parts` (n, count, 8): the next four
/// are the light of flames within the first three, and the transmittance without flames.
///
/// Steps end at block faces and taps. Within a step of length h, layers are composited one after
/// the other; each transmits exp(-extinction h). Single scattering follows Henyey and Greenstein.
/// Multiple scattering is approximated as by M. Wrenninge, C. Kulla and V. Lundqvist (2013, "Oz:
/// The Great and Volumetric"), as in the smoke material. Flames have shorter steps, in slabs
/// of eight, each at its middle in the smoke.
///
/// @param flames may be null
/// @throws std::invalid_argument
void march(Layers layers, const flames::FlameVolume* flames, const Rays& rays, const Taps& taps,
           const Illumination& light, const MarchSettings& settings, std::span<float> out);

} // namespace firetwin::volume
