#include "flux/arrival.hpp"

#include "flux/begin.hpp"
#include "flux/crossing.hpp"
#include "flux/middle.hpp"
#include "geo/axis.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace firetwin::flux {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool has_own(const run::Run& run) {
  return run.has("fuel_arrival_time");
}

std::vector<double> own(const run::Run& run) {
  const std::vector<float> time = run.own_arrival_time();
  return {time.begin(), time.end()};
}

std::size_t nearest(std::span<const double> axis, double value) {
  const geo::Bracket at = geo::bracket(axis, value);
  return at.fraction > 0.5 ? at.upper : at.lower;
}

/// Times of the fluxes at `rows` x `columns`, where half of the ground around burns within the run.
std::vector<double> at(const Middle& middle, const run::Run& run, std::span<const double> rows,
                       std::span<const double> columns) {
  const std::size_t nx = run.longitude().size();
  std::vector<double> result(rows.size() * columns.size(), nan);
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t y) {
    const geo::Bracket row = geo::bracket(run.latitude(), rows[y]);
    for (std::size_t x = 0; x < columns.size(); ++x) {
      const geo::Bracket column = geo::bracket(run.longitude(), columns[x]);
      if (geo::bilinear(std::span<const float>(middle.share), nx, row, column) >= 0.5) {
        result[y * columns.size() + x] =
            std::min(geo::bilinear(std::span<const double>(middle.time), nx, row, column),
                     run.times().back());
      }
    }
  });
  return result;
}

/// The earliest beginning among the fuel cells of each model cell.
std::vector<double> earliest(const run::Run& run) {
  const std::vector<double> arrival = own(run);
  const std::size_t fx = run.fuel_longitude().size(), nx = run.longitude().size();
  const std::vector<double> crossing = crossing_time(arrival, fx);
  std::vector<std::size_t> column(fx);
  std::transform(run.fuel_longitude().begin(), run.fuel_longitude().end(), column.begin(),
                 [&](double place) { return nearest(run.longitude(), place); });
  std::vector<double> result(run.cells(), nan);
  for (std::size_t y = 0; y < run.fuel_latitude().size(); ++y) {
    const std::size_t row = nearest(run.latitude(), run.fuel_latitude()[y]);
    for (std::size_t x = 0; x < fx; ++x) {
      double& time = result[row * nx + column[x]];
      time = std::fmin(time, arrival[y * fx + x] - 0.5 * crossing[y * fx + x]);
    }
  }
  return result;
}

} // namespace

std::vector<double> arrival_time(const run::Run& run) {
  if (!has_own(run)) {
    return at(middle_from_flux(run), run, run.latitude(), run.longitude());
  }
  const std::vector<float> time =
      geo::resample(run.own_arrival_time(), run.fuel_latitude(), run.fuel_longitude(),
                    run.latitude(), run.longitude());
  return {time.begin(), time.end()};
}

std::vector<double> fuel_arrival_time(const run::Run& run) {
  return has_own(run) ? own(run)
                      : at(middle_from_flux(run), run, run.fuel_latitude(), run.fuel_longitude());
}

std::vector<double> begin_time(const run::Run& run) {
  return has_own(run) ? earliest(run) : begin_from_flux(run);
}

} // namespace firetwin::flux
