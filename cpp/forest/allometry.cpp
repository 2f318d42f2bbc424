#include "forest/allometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace firetwin::forest {
namespace {

// Cruz et al. (2003), mixed conifer
constexpr double constant = -4.824, of_basal_area = 0.804, of_stems = 0.333;
constexpr double hectare = 1.0e4;              // m2
constexpr double min_diameter = 0.05;          // m
constexpr double max_diameter = 1.6;           // m
constexpr double inch = 0.0254, foot = 0.3048; // m

constexpr int fuels = 16, parts = 48, steps = 400;
constexpr double fuel_step = 0.25; // kg/m2
constexpr double part_step = -0.2; // step of the logarithm of the retained share

using Table = std::array<std::array<double, parts>, fuels>;

/// Sum of the crown areas of a thinned stand, in squared heights per stem of the unthinned stand.
///
/// A tree with birth order t, in units of the inverse stand density, is retained with probability
/// exp(-t / retained) (see `MaternProcess`); a share of 1 - exp(-t) of all trees is older.
double crowns(double fuel, double retained) {
  const double step = 12.0 * retained / steps;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) * step;
    const double tall = height(fuel, -std::expm1(-t));
    sum += tall * tall * std::exp(-t / retained) * step;
  }
  return sum;
}

Table widenings() {
  Table table;
  for (int i = 0; i < fuels; ++i) {
    const double fuel = std::max(fuel_step * i, min_canopy_fuel), all = crowns(fuel, 1.0);
    for (int k = 0; k < parts; ++k) {
      table[i][k] = std::sqrt(all / crowns(fuel, std::exp(part_step * k)));
    }
  }
  return table;
}

} // namespace

double mean_diameter(double canopy_fuel) {
  return 0.30 * std::sqrt(std::sqrt(canopy_fuel));
}

double stems(double canopy_fuel) {
  // With D^2 proportional to sqrt(W) both sides are powers of W, so N = N(1 kg/m2) W^power.
  static const double one =
      std::exp((-constant - of_basal_area * std::log(0.25 * std::numbers::pi * mean_diameter(1.0) *
                                                     mean_diameter(1.0))) /
               (of_basal_area + of_stems));
  constexpr double power = (1.0 - 0.5 * of_basal_area) / (of_basal_area + of_stems);
  if (!(canopy_fuel > min_canopy_fuel) || !std::isfinite(canopy_fuel)) {
    return 0.0;
  }
  return std::min(one * std::pow(canopy_fuel, power) / hectare, max_stem_density);
}

double height(double canopy_fuel, double rank) {
  const double square = mean_diameter(canopy_fuel) * mean_diameter(canopy_fuel);
  // mean square of a shifted exponential distribution with minimum `least` and mean `least + mean`
  const double mean = 0.5 * (std::sqrt(2.0 * square - min_diameter * min_diameter) - min_diameter);
  const double diameter = std::min(min_diameter - mean * std::log(rank), max_diameter);
  return foot * (4.5 + std::exp(4.86039 - 9.32795 / (diameter / inch + 1.0)));
}

double crown_widening(double canopy_fuel, double retained) {
  static const Table table = widenings();
  const double y = std::clamp(canopy_fuel / fuel_step, 0.0, fuels - 1.0);
  const double x = std::clamp(std::log(retained) / part_step, 0.0, parts - 1.0);
  const int i = std::min(static_cast<int>(y), fuels - 2),
            k = std::min(static_cast<int>(x), parts - 2);
  const double v = y - i, u = x - k;
  return (1.0 - v) * ((1.0 - u) * table[i][k] + u * table[i][k + 1]) +
         v * ((1.0 - u) * table[i + 1][k] + u * table[i + 1][k + 1]);
}

} // namespace firetwin::forest
