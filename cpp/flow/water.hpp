#pragma once

#include "base/gravity.hpp"
#include "flow/lattice.hpp"

/// Thermodynamics of moist air.
namespace firetwin::flow {

inline constexpr double heat_capacity = 1004.7;   // of air at constant pressure, J/kg/K
inline constexpr double gas_constant = 287.05;    // of dry air, J/kg/K
inline constexpr double latent_heat = 2.5e6;      // of vapour, J/kg
inline constexpr double vapour_lightness = 0.608; // of virtual temperature
inline constexpr double reference_pressure = 1e5; // of potential temperature, Pa

/// Air of one level.
struct Weather {
  float reference; ///< K, added to potential temperatures
  float exner;
  float pressure; ///< Pa
};

/// Virtual potential temperature, K, of a row of air with `theta` (K above the reference, were all
/// its water vapour) and `water` kg/kg in all; and `cloud`, the part of that which is cloud water:
/// condensation warms the air until it is just saturated, over water, whose vapour's pressure is
/// Magnus's (Alduchov and Eskridge 1996, doi:10.1175/1520-0450(1996)035<0601:IMFAOS>2.0.CO;2). In
/// float32; cloud water is within 2e-7 kg/kg of float64's.
void virtual_row(Index n, const float* theta, const float* water, const Weather& level,
                 float* virtual_theta, float* cloud);

} // namespace firetwin::flow
