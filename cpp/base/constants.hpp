#pragma once

#include <numbers>

/// Constants shared by several folders. Python: firetwin_core.constants.
namespace firetwin::constants {

// Physics: exact in the SI of 2019; stefan_boltzmann follows from the others (CODATA 2018).
inline constexpr double planck = 6.62607015e-34;           ///< J s
inline constexpr double speed_of_light = 299792458.0;      ///< m/s
inline constexpr double boltzmann = 1.380649e-23;          ///< J/K
inline constexpr double stefan_boltzmann = 5.670374419e-8; ///< W m-2 K-4

/// Standard gravity, m/s2 (3rd General Conference on Weights and Measures, 1901). The local value
/// differs by more than rounding to 9.81 does: 9.796 in the Rubicon canyon.
inline constexpr double gravity = 9.80665;

// Ellipsoid of WGS84 (NIMA TR8350.2).
inline constexpr double semi_major_axis = 6378137.0; ///< m
inline constexpr double flattening = 1.0 / 298.257223563;
inline constexpr double eccentricity_squared = flattening * (2.0 - flattening);

// Dry air.
inline constexpr double gas_constant = 287.05; ///< J/kg/K (U.S. Standard Atmosphere 1976)
inline constexpr double specific_heat =
    1004.7; ///< at constant pressure, J/kg/K: 7/2 of gas_constant
inline constexpr double reference_pressure = 1e5; ///< for potential temperature, Pa
inline constexpr double air_temperature = 290.0;  ///< K, default air temperature
inline constexpr double air_density = 1.2; ///< kg/m3 at air_temperature and 1000 hPa: p / (R T)

/// Buoyancy flux of a heat source, m4/s3 per W: g / (pi cp rho T) (Briggs 1984, "Plume rise and
/// buoyancy effects", in Randerson, Atmospheric Science and Power Production, DOE/TIC-27601).
inline constexpr double buoyancy_flux =
    gravity / (std::numbers::pi * specific_heat * air_density * air_temperature);

/// Low heat of combustion of dry wildland fuel, J/kg (`cmbcnst` of WRF-SFIRE,
/// phys/module_fr_sfire_phys.F).
inline constexpr double heat_of_combustion = 17.433e6;

} // namespace firetwin::constants
