#include "flow/water.hpp"

#include <algorithm>
#include <cmath>

namespace firetwin::flow {
namespace {

constexpr double freezing = 273.15;
constexpr double steepness = 17.625;
constexpr double offset = 243.04; // degrees Celsius
constexpr double molar_ratio = 0.622;

double slope(double temperature, double held) {
  const double t = temperature - freezing + offset;
  return held * steepness * offset / (t * t);
}

} // namespace

double saturation(double temperature, double pressure) {
  const double t = std::clamp(temperature - freezing, -150.0, 90.0);
  const double vapour = 610.94 * std::exp(steepness * t / (t + offset));
  return molar_ratio * vapour / std::max(pressure - (1.0 - molar_ratio) * vapour, vapour);
}

double cloud_water(double temperature, double water, double pressure) {
  double held = saturation(temperature, pressure);
  if (water <= held) {
    return 0.0;
  }
  constexpr double warming = latent_heat / heat_capacity;
  double cloud = 0.0, change = 1.0;
  for (int round = 0; round < 6 && std::abs(change) > 1e-8; ++round) { // Newton's
    const double t = temperature + warming * cloud;
    held = round > 0 ? saturation(t, pressure) : held;
    change = (water - cloud - held) / (1.0 + warming * slope(t, held));
    cloud += change;
  }
  return std::clamp(cloud, 0.0, water);
}

} // namespace firetwin::flow
