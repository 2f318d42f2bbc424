#include "flux/at_time.hpp"

#include "geo/axis.hpp"

#include <cmath>
#include <stdexcept>

namespace firetwin::flux {

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
  return flux;
}

} // namespace firetwin::flux
