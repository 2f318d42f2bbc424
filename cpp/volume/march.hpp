#pragma once

#include "volume/ray.hpp"

#include <array>
#include <span>

namespace firetwin::volume {

using Colour = std::array<float, 3>; ///< linear red, green and blue

/// Light sources and scattering properties of smoke, and haze.
struct Illumination {
  float density;        ///< factor on the extinction
  Colour fresh, old;    ///< albedo of young and of old smoke
  Colour sun;           ///< irradiance
  Colour sky;           ///< mean radiance over all directions
  Vector sun_direction; ///< unit vector to the sun
  double anisotropy;    ///< g of Henyey and Greenstein
  std::array<float, 2>
      multiple_scattering;    ///< weights of light scattered twice and thrice, relative to once
  Colour glow;                ///< radiance where `glow` is 1; black: there is none
  float thin;                 ///< part of the glow that thin smoke scatters
  std::array<float, 2> thick; ///< extinction (1/m) between which that rises to all
  Colour air;                 ///< radiance of haze
  double haze;                ///< its extinction at height 0, 1/m
  double haze_height;         ///< m in which it thins to 1/e
};

/// Distances along rays at which the result is returned.
struct Taps {
  std::span<const float> distances; ///< (n, count) m in any order; more than any smoke: to its end
  std::size_t count;
};

struct MarchSettings {
  double step = 0.5; ///< voxels of the finest layer there
  /// Transmittance at which rays end; the rest is extrapolated.
  double stop = 1.0e-3;
};

/// Ray marching through sparse smoke: radiance and transmittance of each ray up to each tap, (n,
/// count, 4) red, green, blue and transmittance.
///
/// Steps end at blocks and taps. In each, layers one after the other keep exp(-extinction h) of
/// what is behind them. Single scattering is spread after Henyey and Greenstein, more is added as
/// M. Wrenninge, C. Kulla and V. Lundqvist (2013, "Oz: The Great and Volumetric") do, as in the
/// material of smoke.
///
/// @throws std::invalid_argument
void march(Layers layers, const Rays& rays, const Taps& taps, const Illumination& light,
           const MarchSettings& how, std::span<float> out);

} // namespace firetwin::volume
