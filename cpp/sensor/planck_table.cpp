#include "sensor/planck_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace firetwin::sensor {

double PlanckTable::Curve::at(double x) const {
  const double place = (x - start) / step;
  const auto last = static_cast<double>(value.size() - 2);
  const double whole = std::clamp(std::floor(place), 0.0, last);
  const auto i = static_cast<std::size_t>(whole);
  const double t = place - whole, u = 1.0 - t;
  return u * u * ((1.0 + 2.0 * t) * value[i] + t * slope[i]) +
         t * t * ((1.0 + 2.0 * u) * value[i + 1] - u * slope[i + 1]);
}

PlanckTable::PlanckTable(const Band& band, std::size_t knots) : band_(band) {
  check(band);
  if (knots < 2) {
    throw std::invalid_argument("a table needs at least 2 knots");
  }
  least_ = sensor::radiance(lowest, band);
  most_ = sensor::radiance(highest, band);
  const auto steps = static_cast<double>(knots - 1);
  radiance_.start = std::log(lowest);
  radiance_.step = (std::log(highest) - radiance_.start) / steps;
  temperature_.start = std::log(least_);
  temperature_.step = (std::log(most_) - temperature_.start) / steps;
  for (std::size_t i = 0; i < knots; ++i) {
    const auto place = static_cast<double>(i);
    const double kelvin = std::exp(radiance_.start + place * radiance_.step);
    radiance_.value.push_back(std::log(sensor::radiance(kelvin, band)));
    radiance_.slope.push_back(temperature_exponent(kelvin, band) * radiance_.step);
    const double found =
        brightness_temperature(std::exp(temperature_.start + place * temperature_.step), band);
    temperature_.value.push_back(std::log(found));
    temperature_.slope.push_back(temperature_.step / temperature_exponent(found, band));
  }
}

double PlanckTable::radiance(double kelvin) const {
  if (!(kelvin >= lowest && kelvin <= highest)) {
    return sensor::radiance(kelvin, band_);
  }
  return std::exp(radiance_.at(std::log(kelvin)));
}

double PlanckTable::temperature(double radiance) const {
  if (!(radiance >= least_ && radiance <= most_)) {
    return brightness_temperature(radiance, band_);
  }
  return std::exp(temperature_.at(std::log(radiance)));
}

} // namespace firetwin::sensor
