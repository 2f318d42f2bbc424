#include "sensor/thermal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace firetwin::sensor {
namespace {

using Colour = std::array<double, 3>;

constexpr std::array<Colour, 6> stops = {{{0.0, 0.0, 0.0},
                                          {0.5, 0.0, 0.5},
                                          {1.0, 0.0, 0.0},
                                          {1.0, 0.5, 0.0},
                                          {1.0, 1.0, 0.0},
                                          {1.0, 1.0, 1.0}}};

Colour gradient(double fraction) {
  constexpr double last = stops.size() - 1;
  const double at = std::clamp(fraction, 0.0, 1.0) * last;
  const double lower = std::min(std::floor(at), last - 1.0);
  const auto i = static_cast<std::size_t>(lower);
  Colour colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    colour[c] = stops[i][c] + (at - lower) * (stops[i + 1][c] - stops[i][c]);
  }
  return colour;
}

} // namespace

void thermal_composite(std::span<const float> rgb, std::span<const float> kelvin, double low,
                       double high, double strength, std::span<float> colour) {
  if (!std::isfinite(low) || !std::isfinite(high) || !(low < high)) {
    throw std::invalid_argument("low and high must be finite temperatures in K, low below high");
  }
  if (!std::isfinite(strength)) {
    throw std::invalid_argument("strength must be finite");
  }
  for (std::size_t i = 0; i < colour.size(); ++i) {
    const double k = double{kelvin[i / 3]};
    const Colour heat = std::isnan(k) ? stops.front() : gradient((k - low) / (high - low));
    const double pixel = std::isnan(rgb[i]) ? 0.0 : std::clamp(double{rgb[i]}, 0.0, 1.0);
    colour[i] = static_cast<float>(std::clamp(pixel + strength * heat[i % 3], 0.0, 1.0));
  }
}

} // namespace firetwin::sensor
