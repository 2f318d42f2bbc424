"""Constants that several modules share, each defined once (cpp/base/constants.hpp).

GRAVITY: standard gravity, 9.80665 m/s2 (3rd General Conference on Weights and Measures, 1901).
STEFAN_BOLTZMANN: 5.670374419e-8 W m-2 K-4 (CODATA 2018).
SEMI_MAJOR_AXIS: semi-major axis of the WGS84 ellipsoid, 6378137 m (NIMA TR8350.2).
ECCENTRICITY_SQUARED: squared eccentricity of the WGS84 ellipsoid, from its flattening 1 / 298.257223563 (NIMA
TR8350.2).
SPECIFIC_HEAT: specific heat of dry air at constant pressure, 1004.7 J/kg/K: 7/2 of the gas constant 287.05
J/kg/K (U.S. Standard Atmosphere 1976).
AIR_TEMPERATURE: default air temperature, 290 K.
AIR_DENSITY: default air density, 1.2 kg/m3: dry air of AIR_TEMPERATURE at 1000 hPa.
BUOYANCY_FLUX: buoyancy flux of a heat source, m4/s3 per W: g / (pi cp rho T) with the constants above (Briggs
1984).
HEAT_OF_COMBUSTION: low heat of combustion of dry wildland fuel, 17.433e6 J/kg (cmbcnst of WRF-SFIRE).
"""

GRAVITY: float
STEFAN_BOLTZMANN: float
SEMI_MAJOR_AXIS: float
ECCENTRICITY_SQUARED: float
SPECIFIC_HEAT: float
AIR_TEMPERATURE: float
AIR_DENSITY: float
BUOYANCY_FLUX: float
HEAT_OF_COMBUSTION: float
