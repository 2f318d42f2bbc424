#include "sensor/thermal.hpp"

#include "sensor/palette.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firetwin::sensor {

void thermal_composite(std::span<const float> rgb, std::span<const float> kelvin, double low,
                       double high, double strength, std::span<float> colour) {
  if (!std::isfinite(low) || !std::isfinite(high) || !(low < high)) {
    throw std::invalid_argument("low and high must be finite temperatures in K, low below high");
  }
  if (!std::isfinite(strength)) {
    throw std::invalid_argument("strength must be finite");
  }
  const Palette& gradient = palette("paper");
  for (std::size_t i = 0; i < kelvin.size(); ++i) {
    const double k = static_cast<double>(kelvin[i]);
    const Colour heat = gradient.at(std::isnan(k) ? 0.0 : (k - low) / (high - low));
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const double pixel =
          std::isnan(rgb[c]) ? 0.0 : std::clamp(static_cast<double>(rgb[c]), 0.0, 1.0);
      colour[c] = static_cast<float>(std::clamp(pixel + strength * heat[c % 3], 0.0, 1.0));
    }
  }
}

void overlay(std::span<const float> below, std::span<const float> above,
             std::span<const float> kelvin, double start, double full, double opacity,
             std::span<float> colour) {
  if (!std::isfinite(start) || !std::isfinite(full) || !(start < full)) {
    throw std::invalid_argument(
        "start and full must be finite temperatures in K, start below full");
  }
  if (!(opacity >= 0.0 && opacity <= 1.0)) {
    throw std::invalid_argument("opacity must be from 0 to 1");
  }
  for (std::size_t i = 0; i < kelvin.size(); ++i) {
    const double rise = (static_cast<double>(kelvin[i]) - start) / (full - start);
    const double part = rise > 0.0 ? opacity * std::min(rise, 1.0) : 0.0; // NaN: none
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const auto under = static_cast<double>(below[c]);
      colour[c] = static_cast<float>(under + part * (static_cast<double>(above[c]) - under));
    }
  }
}

} // namespace firetwin::sensor
