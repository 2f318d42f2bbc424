#include "flux/interpolator.hpp"

#include "flux/arrival.hpp"
#include "geo/axis.hpp"
#include "run/not_zero.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace firetwin::flux {

Interpolator::Interpolator(std::shared_ptr<const run::Run> run)
    : run_(std::move(run)), begin_(ignition_time(*run_)) {}

SparseFlux Interpolator::at(double time) const {
  if (std::isnan(time)) {
    throw std::invalid_argument("time must not be NaN");
  }
  const std::vector<double>& times = run_->times();
  if (time < times.front() || time > times.back()) {
    return {};
  }
  const geo::Bracket between = geo::bracket(times, time);
  if (between.fraction == 0.0 || between.fraction == 1.0) {
    return *frame(between.fraction == 1.0 ? between.upper : between.lower);
  }
  return step(between.lower)->at(between.fraction);
}

std::shared_ptr<const SparseFlux> Interpolator::frame(std::size_t index) const {
  const std::lock_guard lock(mutex_);
  return frames_.get(index, [&] { return read(index); });
}

std::shared_ptr<const IntervalInterpolator> Interpolator::step(std::size_t index) const {
  const std::lock_guard lock(mutex_);
  return steps_.get(index, [&] {
    const auto before = frames_.get(index, [&] { return read(index); });
    const auto after = frames_.get(index + 1, [&] { return read(index + 1); });
    return IntervalInterpolator(*before, *after, begin_, run_->times()[index],
                                run_->times()[index + 1]);
  });
}

SparseFlux Interpolator::read(std::size_t index) const {
  values_.resize(run_->cells());
  run_->heat_flux().read(index, values_);
  const double time = run_->times()[index];
  SparseFlux result;
  run::each_not_zero(values_, [&](std::size_t i) {
    const float flux = values_[i];
    const bool trace = flux > 0.0F && flux < run::min_fire_flux && !(begin_[i] <= time);
    if (!trace) {
      result.cell.push_back(static_cast<std::int64_t>(i));
      result.flux.push_back(flux);
    }
  });
  return result;
}

} // namespace firetwin::flux
