#pragma once

#include "flames/flames.hpp"
#include "volume/ray.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace firetwin::volume {

/// Air temperature, equal to the smoke's, and black-body band radiance.
struct AirTemperature {
  std::span<const float> kelvin;    ///< (rows, columns) at the model's ground, K; rows to the north
  std::span<const float> elevation; ///< (rows, columns) of the model's ground, m
  std::array<std::int64_t, 2> shape;
  std::array<double, 2> corner,
      spacing;                     ///< x and y of the first value, and distance between values, m
  double lapse;                    ///< K/m
  std::span<const float> radiance; ///< at evenly spaced, rising temperatures
  double coldest, kelvin_step;     ///< temperature of the first radiance, and the spacing, K
  double absorption;               ///< infrared absorption / extinction in green light
};

/// Excess temperature of the hot gases of a fire over the air, on cells that follow the terrain.
struct HotGas {
  std::span<const float> excess;     ///< [nz][ny][nx] K
  std::span<const float> heights;    ///< [nz][ny][nx] elevation of cell centres, m
  std::array<std::int64_t, 3> shape; ///< nz, ny, nx
  std::array<double, 2> first;       ///< x and y of the first cell's centre, m
  double spacing;                    ///< m

  /// Interpolates linearly; 0 outside of the cells, constant below the lowest.
  float at(const Vector& place) const;
};

struct HotGases {
  std::span<const HotGas> cells; ///< the finest last: the last one with an excess at a place counts
  double absorption;             ///< where smoke is visible, 1/(m K)
};

/// Ray marching in the infrared with absorption and emission but without scattering: (n, 2)
/// radiance and transmittance up to each ray's distance (n). The temperature is constant within a
/// step.
///
/// @param flames may be null; their temperatures must be within the table of radiance
/// @throws std::invalid_argument
void march_infrared(Layers layers, const flames::FlameVolume* flames, const Rays& rays,
                    std::span<const float> distances, const AirTemperature& air,
                    const HotGases& hot, double step, std::span<float> out);

} // namespace firetwin::volume
