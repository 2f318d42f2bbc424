#include "flux/emitters.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firetwin::flux {
namespace {

void reserve(Emitters& e, std::size_t n) {
  e.cell.reserve(n);
  e.position.reserve(3 * n);
  e.intensity.reserve(n);
  e.scale.reserve(n);
  e.colour.reserve(n);
  e.flux.reserve(n);
}

/// F_curved (see emitters.hpp).
double curved(double flux, double flux_min, double flux_max) {
  const double range = flux_max - flux_min;
  if (range == 0.0) {
    return flux >= flux_max ? 1.0 : 0.0;
  }
  const double normalised = std::clamp((flux - flux_min) / range, 0.0, 1.0);
  return normalised * std::sqrt(normalised);
}

} // namespace

Emitters emitters(std::span<const float> flux, std::span<const double> position, double flux_min,
                  double flux_max) {
  if (!std::isfinite(flux_min) || !std::isfinite(flux_max) || flux_min > flux_max) {
    throw std::invalid_argument(
        "flux_min and flux_max must be finite, and flux_min must not be above flux_max");
  }
  Emitters e;
  reserve(e, static_cast<std::size_t>(
                 std::count_if(flux.begin(), flux.end(), [](float f) { return f > 0.0F; })));
  for (std::size_t i = 0; i < flux.size(); ++i) {
    e.invalid += std::isnan(flux[i]);
    if (!(flux[i] > 0.0F)) {
      continue;
    }
    const double intensity = curved(double{flux[i]}, flux_min, flux_max);
    e.cell.push_back(static_cast<std::int64_t>(i));
    e.position.insert(e.position.end(), &position[3 * i], &position[3 * i] + 3);
    e.intensity.push_back(intensity);
    e.scale.push_back(100.0 + 50.0 * intensity);
    e.colour.push_back(100.0 + 400.0 * intensity);
    e.flux.push_back(flux[i]);
  }
  return e;
}

} // namespace firetwin::flux
