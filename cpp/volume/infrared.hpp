#pragma once

#include "volume/ray.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace firetwin::volume {

/// Air temperature, which is the smoke's, and the band radiance of black bodies.
struct AirTemperature {
  std::span<const float> kelvin;    ///< (rows, columns) at the model's ground, rows to the north
  std::span<const float> elevation; ///< (rows, columns) of the model's ground, m
  std::array<std::int64_t, 2> shape;
  std::array<double, 2> corner,
      spacing;                     ///< x and y: the first value's place, and between values, m
  double lapse;                    ///< K/m
  std::span<const float> radiance; ///< at temperatures that rise in equal steps
  double coldest, kelvin_step;     ///< the first one's temperature and the step, K
  double absorption;               ///< per extinction in green light
};

/// Infrared ray marching with absorption and emission and without scattering: (n, 2) radiance and
/// transmittance up to each ray's distance (n). A block has one temperature.
///
/// @throws std::invalid_argument
void march_infrared(Layers layers, const Rays& rays, std::span<const float> distances,
                    const AirTemperature& air, double step, std::span<float> out);

} // namespace firetwin::volume
