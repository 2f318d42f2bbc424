#include "flux/interval_interpolator.hpp"

#include <algorithm>
#include <cmath>

namespace firetwin::flux {
namespace {

/// Allowed deviation of new cells from a linear sum, as a fraction of the other cells' F^1.5.
/// Smoothing of sudden rises may add the same amount.
constexpr double slack = 0.025;
/// Minimum rise time of a new cell as a fraction of the interval, if the slack allows it.
constexpr double min_rise = 1.0 / 16.0;
/// Tolerance for equal times, as a fraction of an interval.
constexpr double same_time = 1e-6;

/// F^1.5; 0 for cells that do not burn.
double brightness(double flux) {
  return flux > 0.0 ? flux * std::sqrt(flux) : 0.0;
}

double flux_of(double brightness) {
  return std::cbrt(brightness * brightness);
}

double between(double before, double after, double fraction) {
  return (1.0 - fraction) * before + fraction * after;
}

} // namespace

IntervalInterpolator::IntervalInterpolator(const SparseFlux& before, const SparseFlux& after,
                                           std::span<const double> begin, double start, double end)
    : start_(start), end_(end) {
  cells_.reserve(std::max(before.cell.size(), after.cell.size()));
  std::size_t b = 0, a = 0;
  while (b < before.cell.size() || a < after.cell.size()) {
    const bool no_after = a == after.cell.size();
    const bool no_before = b == before.cell.size();
    const bool has_before = !no_before && (no_after || before.cell[b] <= after.cell[a]);
    const bool has_after = !no_after && (no_before || after.cell[a] <= before.cell[b]);
    const std::int64_t cell = has_before ? before.cell[b] : after.cell[a];
    add(cell, has_before ? before.flux[b] : 0.0F, has_after ? after.flux[a] : 0.0F,
        begin[static_cast<std::size_t>(cell)]);
    b += has_before ? 1 : 0;
    a += has_after ? 1 : 0;
  }
  std::stable_sort(beginnings_.begin(), beginnings_.end(),
                   [](const Beginning& x, const Beginning& y) { return x.time < y.time; });
  leeway_ = slack * std::min(old_before_, old_after_) / new_;
}

void IntervalInterpolator::add(std::int64_t cell, float before, float after, double begin) {
  Cell c = {cell, before, after, brightness(double{before}), brightness(double{after})};
  if (!(before > 0.0F) && after > 0.0F && !(begin <= start_)) {
    c.course = Course::begins;
    const double time = std::isnan(begin) ? 0.5 : (begin - start_) / (end_ - start_);
    beginnings_.push_back({cells_.size(), std::min(time, 1.0)});
    new_ += c.bright_after;
  } else if (before >= 0.0F && after >= 0.0F) {
    old_before_ += c.bright_before;
    old_after_ += c.bright_after;
  } else {
    c.course = Course::linear;
  }
  cells_.push_back(c);
}

/// Progress, 0 to 1, of the new cells with one arrival time. All times are fractions of the
/// interval.
/// @param turn start of their rise if all new cells rose one after the other
/// @param share their share in the final F^1.5 of all new cells
double IntervalInterpolator::rise(double fraction, double arrival, double turn,
                                  double share) const {
  const double near = std::clamp(arrival, turn - leeway_, turn + leeway_);
  const double begin = std::clamp(near, 0.0, 1.0 - std::min(share, min_rise));
  const double length = std::min(std::max(share, std::min(leeway_, min_rise)), 1.0 - begin);
  return std::clamp((fraction - begin) / length, 0.0, 1.0);
}

/// Adds the new cells in the order of their arrival. Returns the sum of their F^1.5.
double IntervalInterpolator::light(double fraction, std::vector<double>& found) const {
  double lit = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < beginnings_.size();) {
    // Cells with equal arrival times (within rounding) rise together.
    std::size_t end = i;
    double own = 0.0;
    for (; end < beginnings_.size() && beginnings_[end].time - beginnings_[i].time < same_time;
         ++end) {
      own += cells_[beginnings_[end].index].bright_after;
    }
    const double risen = rise(fraction, beginnings_[i].time, lit / new_, own / new_);
    for (; i < end; ++i) {
      found[beginnings_[i].index] = risen * cells_[beginnings_[i].index].bright_after;
    }
    sum += risen * own;
    lit += own;
  }
  return sum;
}

SparseFlux IntervalInterpolator::at(double fraction) const {
  std::vector<double> found(cells_.size(), 0.0);
  double old = 0.0;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i].course == Course::even) {
      old += found[i] = between(cells_[i].bright_before, cells_[i].bright_after, fraction);
    }
  }
  const double wanted = (old + fraction * new_) / (old + light(fraction, found));
  const double factor = std::isfinite(wanted) ? wanted : 1.0;
  SparseFlux result;
  result.cell.reserve(cells_.size());
  result.flux.reserve(cells_.size());
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Cell& c = cells_[i];
    const double flux = c.course == Course::linear
                            ? between(double{c.before}, double{c.after}, fraction)
                            : flux_of(factor * found[i]);
    if (flux != 0.0) {
      result.cell.push_back(c.cell);
      result.flux.push_back(static_cast<float>(flux));
    }
  }
  return result;
}

} // namespace firetwin::flux
