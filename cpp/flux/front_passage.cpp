#include "flux/front_passage.hpp"

#include "flux/crossing_time.hpp"
#include "flux/fuel.hpp"
#include "flux/ignition_time.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

namespace firetwin::flux {
namespace {

/// A cell has burned out if its remaining heat is less than this fraction of its total.
constexpr double left_over = 0.05;
/// Minimum number of burned-out cells inside the fire for statistics.
constexpr std::size_t enough_cells = 10;
constexpr double min_share = 0.02;
constexpr double min_delay = 1.0; ///< s
/// Relative standard deviations of the crossing time, the delay and the heat of a cell.
constexpr double ragged = 0.8, uneven_fuel = 0.5, uneven_heat = 0.25;
constexpr std::size_t heat_reach =
    2; ///< radius of the neighbourhood for the heat of a burned-out cell, cells

double square(double value) {
  return value * value;
}

/// Fraction of its heat that a cell has released `age` s after ignition. The front takes `crossing`
/// s to cross it; each point burns as exp(-age / delay) (Mandel et al. 2011, eq. 3).
double released(double age, double crossing, double delay) {
  const double lit = std::min(age, crossing);
  return (lit - delay * (std::exp(-(age - lit) / delay) - std::exp(-age / delay))) / crossing;
}

/// Crossing time for which a cell has released the fraction `part`; 0 if no front is that fast.
double crossing_by_heat(double age, double part, double delay) {
  if (released(age, age, delay) >= part) { // the front is in the cell or has just left it
    return age * released(age, age, delay) / part;
  }
  double low = 0.0, high = age;
  for (int step = 0; step < 30; ++step) {
    const double middle = 0.5 * (low + high);
    (released(age, middle, delay) > part ? low : high) = middle;
  }
  return low;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class Estimator {
public:
  explicit Estimator(const run::Run& run)
      : cells_(run.scan().cells), times_(run.times()), rows_(run.latitude().size()),
        columns_(run.longitude().size()), begin_(ignition_time_from_flux(run)),
        crossing_(crossing_time(begin_, columns_)), fuel_(fuel_of_cells(run)),
        half_mean_(half_mean(run, usual_interval())), half_last_(half_mean(run, last_interval())) {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      whole_.push_back(burns(i) && cells_[i].first > 0 && burned_out(i) && inside(i));
    }
    find_delay();
  }

  FrontPassage middle() const {
    FrontPassage result{std::vector<double>(cells_.size(), nan),
                        std::vector<float>(cells_.size(), 0.0F)};
    tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t i) {
      if (burns(i) && cells_[i].first > 0) {
        result.time[i] = time(i);
        result.burned_fraction[i] = static_cast<float>(share_at_end(i, result.time[i]));
      }
    });
    const double pace = usual_crossing(result.time);
    add_first(result, pace);
    extend(result, pace);
    return result;
  }

private:
  bool burns(std::size_t i) const { return cells_[i].first != run::Scan::never; }

  /// Time from the centre of a flux's averaging interval to its model time, s; 0 for instantaneous
  /// values.
  static double half_mean(const run::Run& run, double interval) {
    return 0.5 * std::min(run.description().mean_s.value_or(interval), interval);
  }

  double usual_interval() const {
    return times_.size() > 1 ? (times_.back() - times_.front()) / double(times_.size() - 1) : 0.0;
  }

  double last_interval() const {
    return times_.size() > 1 ? times_.back() - times_[times_.size() - 2] : 0.0;
  }

  /// Heat of a cell until the end of the run, J/m2. The trapezoidal rule counts half of the last
  /// flux, which is right for instantaneous values; the other half is added for means.
  double heat_so_far(std::size_t i) const {
    return cells_[i].heat + half_last_ * double{cells_[i].last};
  }

  /// Fuel load for the heat of a cell, kg/m2; 1 if the fuel is unknown.
  double fuel(std::size_t i) const { return fuel_.empty() ? 1.0 : fuel_[i]; }

  /// Mean time of a cell's heat release, s.
  double heat_time(std::size_t i) const {
    return times_.front() + cells_[i].moment / cells_[i].heat - half_mean_;
  }

  bool burned_out(std::size_t i) const {
    const double since = times_.back() - heat_time(i);
    return double{cells_[i].last} * since < left_over * cells_[i].heat;
  }

  template <class Visit> void around(std::size_t i, std::size_t reach, const Visit& visit) const {
    const std::size_t y = i / columns_, x = i % columns_;
    for (std::size_t v = y - std::min(reach, y); v <= std::min(y + reach, rows_ - 1); ++v) {
      for (std::size_t u = x - std::min(reach, x); u <= std::min(x + reach, columns_ - 1); ++u) {
        visit(v * columns_ + u);
      }
    }
  }

  /// True if all neighbours burn, so that the front has crossed the cell completely.
  bool inside(std::size_t i) const {
    bool all = true;
    around(i, 1, [&](std::size_t k) { all = all && burns(k); });
    return all;
  }

  void find_delay() {
    std::vector<double> times(cells_.size(), nan), heats, delays;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      times[i] = whole_[i] ? heat_time(i) : nan;
    }
    const std::vector<double> crossing = crossing_time(times, columns_);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (whole_[i]) {
        heats.push_back(cells_[i].heat / fuel(i));
        delays.push_back(times[i] - begin_[i] - 0.5 * crossing[i]);
      }
    }
    if (heats.size() >= enough_cells) {
      heat_ = median(heats);
      delay_ = std::max(median(delays), min_delay);
    }
  }

  /// Burned fraction of a cell, from its heat so far.
  double share(std::size_t i) const {
    if (whole_[i]) {
      return 1.0;
    }
    double heat = 0.0, load = 0.0;
    around(i, heat_reach, [&](std::size_t k) {
      heat += whole_[k] ? cells_[k].heat : 0.0;
      load += whole_[k] ? fuel(k) : 0.0;
    });
    const double usual = load > 0.0 ? heat / load : heat_;
    return std::clamp(heat_so_far(i) / (usual * fuel(i)), min_share, 1.0);
  }

  double time(std::size_t i) const {
    const double from_slope = begin_[i] + 0.5 * crossing_[i];
    if (!delay_) {
      return from_slope;
    }
    const auto [time_in, deviation] = burned_out(i) ? by_mean_time(i) : by_heat_so_far(i);
    const double interval = times_[cells_[i].first] - times_[cells_[i].first - 1];
    const double heat_variance = square(deviation) + square(interval) / 12.0;
    const double slope_variance = square(ragged * wide_crossing(i));
    const double weight = slope_variance / (slope_variance + heat_variance);
    return from_slope + weight * (begin_[i] + time_in - from_slope);
  }

  /// Largest crossing time by the slopes in and around a cell, s.
  double wide_crossing(std::size_t i) const {
    double sum = 0.0, count = 0.0;
    around(i, 1, [&](std::size_t k) {
      sum += burns(k) ? crossing_[k] : 0.0;
      count += burns(k) ? 1.0 : 0.0;
    });
    return std::max(crossing_[i], sum / count);
  }

  /// Time from ignition of a cell to the passage of its centre, and its standard deviation, s.
  using TimeIn = std::pair<double, double>;

  /// Estimate from the mean time of heat release, at a constant pace over the burned fraction.
  TimeIn by_mean_time(std::size_t i) const {
    const double found = std::max(heat_time(i) - *delay_ - begin_[i], 0.0) / share(i);
    return {found, std::hypot(uneven_fuel * *delay_, uneven_heat * found)};
  }

  /// Estimate from the heat so far, with the variance of heat and delay among cells.
  TimeIn by_heat_so_far(std::size_t i) const {
    const double age = times_.back() - begin_[i], part = share(i);
    const auto time_in = [&](double heat, double delay) {
      return 0.5 * crossing_by_heat(age, std::min(part * heat, 1.0), *delay_ * delay);
    };
    const double of_heat = time_in(1.0 - uneven_heat, 1.0) - time_in(1.0 + uneven_heat, 1.0);
    const double of_delay = time_in(1.0, 1.0 - uneven_fuel) - time_in(1.0, 1.0 + uneven_fuel);
    return {time_in(1.0, 1.0), 0.5 * std::hypot(of_heat, of_delay)};
  }

  double share_at_end(std::size_t i, double time) const {
    if (delay_ && burned_out(i)) {
      return share(i);
    }
    const double crossing = 2.0 * (time - begin_[i]), left = times_.back() - time;
    return crossing > 0.0 ? std::clamp(0.5 + left / crossing, 0.0, 1.0) : 1.0;
  }

  double usual_crossing(const std::vector<double>& time) const {
    std::vector<double> found;
    for (std::size_t i = 0; i < time.size(); ++i) {
      if (!std::isnan(time[i])) {
        found.push_back(2.0 * (time[i] - begin_[i]));
      }
    }
    return found.empty() ? 0.0 : median(found);
  }

  /// Cells that burn at the first model time: the outermost ignite then, inner ones earlier at the
  /// usual pace.
  void add_first(FrontPassage& result, double pace) const {
    std::vector<std::size_t> edge, next;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (cells_[i].first != 0) {
        continue;
      }
      result.burned_fraction[i] = 1.0F;
      bool outermost = false;
      around(i, 1, [&](std::size_t k) { outermost = outermost || cells_[k].first != 0; });
      if (outermost) {
        result.time[i] = times_.front();
        edge.push_back(i);
      }
    }
    for (double time = times_.front(); !edge.empty(); edge.swap(next)) {
      time -= pace;
      next.clear();
      for (const std::size_t i : edge) {
        around(i, 1, [&](std::size_t k) {
          if (cells_[k].first == 0 && std::isnan(result.time[k])) {
            result.time[k] = time;
            next.push_back(k);
          }
        });
      }
    }
    for (std::size_t i = 0; i < cells_.size(); ++i) { // if all of the grid burns
      if (cells_[i].first == 0 && std::isnan(result.time[i])) {
        result.time[i] = times_.front();
      }
    }
  }

  /// Extrapolates to one cell beyond the fire at the pace of its neighbours.
  void extend(FrontPassage& result, double pace) const {
    std::vector<std::pair<std::size_t, double>> ring;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (burns(i)) {
        continue;
      }
      double sum = 0.0, count = 0.0;
      around(i, 1, [&](std::size_t k) {
        if (burns(k)) {
          sum += result.time[k] + (cells_[k].first > 0 ? 2.0 * (result.time[k] - begin_[k]) : pace);
          count += 1.0;
        }
      });
      if (count > 0.0) {
        ring.emplace_back(i, sum / count);
      }
    }
    for (const auto& [i, time] : ring) {
      result.time[i] = time;
    }
  }

  const std::vector<run::Scan::Cell>& cells_;
  const std::vector<double>& times_;
  std::size_t rows_, columns_;
  std::vector<double> begin_;    ///< s
  std::vector<double> crossing_; ///< s, from the slope of begin_
  std::vector<double> fuel_;     ///< kg/m2; empty if unknown
  double half_mean_, half_last_; ///< s, for all fluxes and for the last one
  std::vector<bool> whole_;      ///< burned out, with burning cells on all sides
  double heat_ = 0.0;            ///< J/kg, median over cells of whole_
  std::optional<double> delay_;  ///< s from arrival to heat release; empty with too few cells
};

} // namespace

FrontPassage front_passage_from_flux(const run::Run& run) {
  return Estimator(run).middle();
}

} // namespace firetwin::flux
