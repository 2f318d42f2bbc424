#pragma once

/// Thermodynamics of moist air.
namespace firetwin::flow {

inline constexpr double gravity = 9.80665;        // m/s2
inline constexpr double heat_capacity = 1004.7;   // of air at constant pressure, J/kg/K
inline constexpr double gas_constant = 287.05;    // of dry air, J/kg/K
inline constexpr double latent_heat = 2.5e6;      // of vapour, J/kg
inline constexpr double vapour_lightness = 0.608; // of virtual temperature
inline constexpr double reference_pressure = 1e5; // of potential temperature, Pa

/// Water that air can hold as vapour, kg/kg (Magnus; Alduchov and Eskridge 1996, doi:10.1175/
/// 1520-0450(1996)035<0601:IMFAOS>2.0.CO;2).
double saturation(double temperature, double pressure);

/// Cloud water, kg/kg, of air with `water` kg/kg in all, whose temperature would be `temperature`
/// (K) if all of it were vapour: condensation warms it until it is just saturated.
double cloud_water(double temperature, double water, double pressure);

} // namespace firetwin::flow
