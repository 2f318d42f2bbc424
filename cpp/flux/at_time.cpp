#include "flux/at_time.hpp"

#include "flux/arrival.hpp"
#include "flux/distance.hpp"
#include "geo/axis.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

namespace firetwin::flux {
namespace {

/// How far new cells may be ahead or behind, as a share of the F^1.5 of the other cells; what makes
/// them rise less suddenly may take as much again.
constexpr double slack = 0.025;
/// A new cell rises over at least this part of an interval, if the slack allows it.
constexpr double least_rise = 1.0 / 16.0;

/// Part of an interval.
constexpr double same_time = 1e-6;

/// F^1.5; 0 for what does not burn.
double brightness(double flux) {
  return flux > 0.0 ? flux * std::sqrt(flux) : 0.0;
}

double flux_of(double brightness) {
  return std::cbrt(brightness * brightness);
}

/// Two frames and the way from one to the other.
struct Step {
  std::span<const float> before, after;
  double fraction;

  bool changes_linearly(std::size_t i) const { return !(before[i] >= 0.0F && after[i] >= 0.0F); }
  double linear(std::size_t i) const {
    return (1.0 - fraction) * double{before[i]} + fraction * double{after[i]};
  }
  double even_brightness(std::size_t i) const {
    return (1.0 - fraction) * brightness(double{before[i]}) +
           fraction * brightness(double{after[i]});
  }
};

/// F^1.5 of a frame, cell by cell.
class Brightness {
public:
  explicit Brightness(const Step& step) : step_(step), values_(step.before.size(), 0.0) {}

  /// Lights the new cells, by and by, in the order of their arrival.
  /// @param arrivals as fractions of the interval, ascending
  void light(std::span<const Beginning> arrivals) {
    add_old(arrivals);
    double all = 0.0;
    for (const Beginning& a : arrivals) {
      all += brightness(double{step_.after[a.cell]});
    }
    const double leeway = slack * std::min(old_before_, old_after_) / all;
    double lit = 0.0;
    for (std::size_t i = 0; i < arrivals.size();) {
      const std::size_t end = end_of_group(arrivals, i);
      double own = 0.0;
      for (const Beginning& a : arrivals.subspan(i, end - i)) {
        own += brightness(double{step_.after[a.cell]});
      }
      const double risen = rise(arrivals[i].time, lit / all, own / all, leeway);
      for (const Beginning& a : arrivals.subspan(i, end - i)) {
        values_[a.cell] = risen * brightness(double{step_.after[a.cell]});
      }
      new_ += risen * own;
      lit += own;
      i = end;
    }
    due_ = step_.fraction * all;
  }

  /// Flux [ny nx] in W/m2.
  std::vector<float> flux() const {
    const double sum = old_ + new_;
    const double wanted = (old_ + due_) / sum;
    const double factor = sum > 0.0 && std::isfinite(wanted) ? wanted : 1.0;
    std::vector<float> result(values_.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
      const bool linear = std::isnan(values_[i]);
      result[i] = static_cast<float>(linear ? step_.linear(i) : flux_of(factor * values_[i]));
    }
    return result;
  }

private:
  /// Cells that the front reaches together, to rounding, are lit together.
  static std::size_t end_of_group(std::span<const Beginning> arrivals, std::size_t begin) {
    std::size_t end = begin + 1;
    while (end < arrivals.size() && arrivals[end].time - arrivals[begin].time < same_time) {
      ++end;
    }
    return end;
  }

  void add_old(std::span<const Beginning> arrivals) {
    std::vector<bool> is_new(values_.size(), false);
    for (const Beginning& a : arrivals) {
      is_new[a.cell] = true;
    }
    for (std::size_t i = 0; i < values_.size(); ++i) {
      if (is_new[i]) {
        continue;
      }
      if (step_.changes_linearly(i)) {
        values_[i] = std::numeric_limits<double>::quiet_NaN();
        continue;
      }
      old_ += values_[i] = step_.even_brightness(i);
      old_before_ += brightness(double{step_.before[i]});
      old_after_ += brightness(double{step_.after[i]});
    }
  }

  /// How far, 0 to 1, new cells of one arrival have come. All times are fractions of the interval.
  /// @param turn when they would be lit if all new cells were lit one after the other
  /// @param share of them in what the new cells have in the end
  double rise(double arrival, double turn, double share, double leeway) const {
    const double near = std::clamp(arrival, turn - leeway, turn + leeway);
    const double begin = std::clamp(near, 0.0, 1.0 - std::min(share, least_rise));
    const double length = std::min(std::max(share, std::min(leeway, least_rise)), 1.0 - begin);
    return std::clamp((step_.fraction - begin) / length, 0.0, 1.0);
  }

  Step step_;
  std::vector<double> values_; ///< NaN where a cell changes linearly
  double old_ = 0.0, old_before_ = 0.0, old_after_ = 0.0;
  double new_ = 0.0, due_ = 0.0;
};

/// The cells between the fronts of two model times.
class Band {
public:
  Band(const run::Run& run, double before, double after)
      : Band(run.arrival_time(0.0), run, static_cast<float>(before), static_cast<float>(after)) {}

  /// Averages a time, as a fraction of the interval, with that from where the cell lies between
  /// the fronts: (d0 - 1/2) / (d0 + d1 - 1), with the distances in cells d0 to the nearest cell
  /// that burned before and d1 to the nearest that does not burn yet. It is uniform in a cell.
  void average(Beginning& b) const {
    const double d0 = to_burned_.from(b.cell / columns_, b.cell % columns_);
    const double d1 = to_unburned_.from(b.cell / columns_, b.cell % columns_);
    const double width = d0 + d1 - 1.0;
    if (std::isfinite(width)) {
      const double variance = 1.0 / (12.0 * width * width);
      const double weight = b.variance / (b.variance + variance);
      b.time += weight * ((d0 - 0.5) / width - b.time);
    }
  }

private:
  template <class Test>
  static std::vector<std::uint8_t> marked(const std::vector<float>& arrival, Test test) {
    std::vector<std::uint8_t> result(arrival.size());
    std::transform(arrival.begin(), arrival.end(), result.begin(), test);
    return result;
  }

  Band(const std::vector<float>& arrival, const run::Run& run, float before, float after)
      : columns_(run.longitude().size()),
        to_burned_(marked(arrival, [before](float t) { return t <= before; }),
                   run.latitude().size(), columns_),
        to_unburned_(marked(arrival, [after](float t) { return !(t <= after); }),
                     run.latitude().size(), columns_) {}

  std::size_t columns_;
  Distance to_burned_, to_unburned_;
};

/// Arrivals in the interval, as fractions of it, ascending.
std::vector<Beginning> arrivals(const run::Run& run, const geo::Bracket& at) {
  constexpr bool averaged = true;
  std::vector<Beginning> found = beginnings(run, at.upper, averaged);
  const double begin = run.times()[at.lower], end = run.times()[at.upper];
  const Band band(run, begin, end);
  for (Beginning& b : found) {
    b.time = (b.time - begin) / (end - begin);
    b.variance /= (end - begin) * (end - begin);
    band.average(b);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Beginning& a, const Beginning& b) { return a.time < b.time; });
  return found;
}

} // namespace

std::vector<float> at_time(const run::Run& run, double time) {
  if (std::isnan(time)) {
    throw std::invalid_argument("time must be a number of seconds, not NaN");
  }
  const std::vector<double>& times = run.times();
  std::vector<float> before(run.cells(), 0.0F);
  if (time < times.front() || time > times.back()) {
    return before;
  }
  const geo::Bracket at = geo::bracket(times, time);
  run.heat_flux().read(at.fraction == 1.0 ? at.upper : at.lower, before);
  if (at.fraction == 0.0 || at.fraction == 1.0) {
    return before;
  }
  std::vector<float> after(before.size());
  run.heat_flux().read(at.upper, after);
  Brightness brightness({before, after, at.fraction});
  brightness.light(arrivals(run, at));
  return brightness.flux();
}

} // namespace firetwin::flux
