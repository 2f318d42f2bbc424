#include "volume/plume.hpp"

#include "base/constants.hpp"

#include <algorithm>
#include <cmath>

namespace firetwin::volume {
namespace {

constexpr double convective_part = 0.7; // share of the heat that is not radiated away
constexpr double briggs_height = 300.0;
constexpr double least_wind = 0.5; // m/s; less counts as calm, as in EMRISE
constexpr double wind_exponent = 0.1;
constexpr int drift_steps = 12; // of the drift integral: error below 0.2 %

/// Returns the wind at `height` m above ground, for a wind of `wind10` m/s at 10 m.
double wind_at(double wind10, double height) {
  return wind10 * std::pow(std::max(height, 10.0) / 10.0, wind_exponent);
}

} // namespace

Plume::Plume(double power, double wind, double stability)
    : flux_(constants::buoyancy_flux * convective_part * std::max(power, 0.0)),
      wind_(std::max(wind, 0.0)), wind_aloft_(std::max(wind_at(wind_, briggs_height), least_wind)) {
  const double windy = 2.6 * std::cbrt(flux_ / (wind_aloft_ * stability));
  const double calm = 5.3 * std::pow(flux_, 0.25) * std::pow(stability, -0.375);
  final_rise_ = std::min(windy, calm);
}

double Plume::rise(double age) const {
  if (age <= 0.0 || final_rise_ <= 0.0) {
    return 0.0;
  }
  // With x = U t, 1.6 Fb^(1/3) x^(2/3) / U = 1.6 (Fb / U)^(1/3) t^(2/3).
  const double transition = 1.6 * std::cbrt(flux_ / wind_aloft_ * age * age);
  const double ratio = transition / final_rise_;
  return transition * std::pow(1.0 + ratio * ratio * ratio * ratio, -0.25);
}

double Plume::drift(double age) const {
  // Midpoint rule in u with t = age u^2: short steps where the smoke rises fastest.
  double sum = 0.0;
  for (int i = 0; i < drift_steps; ++i) {
    const double u = (i + 0.5) / drift_steps;
    sum += wind_at(wind_, rise(age * u * u)) * 2.0 * u;
  }
  return std::max(age, 0.0) * sum / drift_steps;
}

} // namespace firetwin::volume
