#include "flux/at_time.hpp"

#include "flux/distance.hpp"
#include "geo/axis.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace firetwin::flux {
namespace {

/// When, as a fraction of the interval, the front reaches the cell at (y, x).
double arrival(const Distance& burned, const Distance& unburned, std::size_t y, std::size_t x) {
  const double d0 = burned.from(y, x);
  const double d1 = unburned.from(y, x);
  return std::isfinite(d0) && std::isfinite(d1) ? (d0 - 0.5) / (d0 + d1 - 1.0) : 0.0;
}

/// Replaces linear fluxes by those behind a moving front, in the cells that first burn in the
/// interval.
void move_front(const run::Run& run, const geo::Bracket& at, std::span<const float> next,
                std::span<float> flux) {
  const std::size_t ny = run.latitude().size();
  const std::size_t nx = run.longitude().size();
  const std::vector<float> arrivals = run.arrival_time(0.0);
  const auto before = static_cast<float>(run.times()[at.lower]);
  const auto after = static_cast<float>(run.times()[at.upper]);
  std::vector<std::uint8_t> burned(arrivals.size());
  std::vector<std::uint8_t> unburned(arrivals.size());
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    burned[i] = arrivals[i] <= before;
    unburned[i] = !(arrivals[i] <= after);
  }
  const Distance to_burned(burned, ny, nx);
  const Distance to_unburned(unburned, ny, nx);
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    if (!burned[i] && !unburned[i]) {
      const double start = arrival(to_burned, to_unburned, i / nx, i % nx);
      const double rise = std::max(0.0, (at.fraction - start) / (1.0 - start));
      flux[i] = static_cast<float>(rise * next[i]);
    }
  }
}

} // namespace

std::vector<float> at_time(const run::Run& run, double time) {
  if (std::isnan(time)) {
    throw std::invalid_argument("time must be a number of seconds, not NaN");
  }
  const std::vector<double>& times = run.times();
  std::vector<float> flux(run.cells(), 0.0F);
  if (time < times.front() || time > times.back()) {
    return flux;
  }
  const geo::Bracket at = geo::bracket(times, time);
  run.heat_flux().read(at.fraction == 1.0 ? at.upper : at.lower, flux);
  if (at.fraction == 0.0 || at.fraction == 1.0) {
    return flux;
  }
  std::vector<float> next(flux.size());
  run.heat_flux().read(at.upper, next);
  for (std::size_t i = 0; i < flux.size(); ++i) {
    flux[i] = static_cast<float>((1.0 - at.fraction) * flux[i] + at.fraction * next[i]);
  }
  move_front(run, at, next, flux);
  return flux;
}

} // namespace firetwin::flux
