#pragma once

#include "base/constants.hpp"
#include "flow/lattice.hpp"

/// Thermodynamics of moist air.
namespace firetwin::flow {

inline constexpr double latent_heat = 2.5e6;      // of vapour, J/kg
inline constexpr double vapour_lightness = 0.608; // virtual temperature coefficient

/// Reference values of one level.
struct LevelReference {
  float reference; ///< K, added to potential temperatures
  float exner;
  float pressure; ///< Pa
};

/// Computes virtual potential temperature (K) and cloud water (kg/kg) of a row of air by saturation
/// adjustment. Saturation is over water, with Magnus's vapour pressure (Alduchov and Eskridge 1996,
/// doi:10.1175/1520-0450(1996)035<0601:IMFAOS>2.0.CO;2). Float32; cloud water is within 2e-7 kg/kg
/// of float64.
/// @param theta liquid water potential temperature minus the reference, K
/// @param water total water mixing ratio, kg/kg
void virtual_row(Index n, const float* theta, const float* water, const LevelReference& level,
                 float* virtual_theta, float* cloud);

} // namespace firetwin::flow
