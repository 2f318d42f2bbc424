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

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// A cell has burned out when what it still gives would be less than this part of its heat.
constexpr double left_over = 0.05;
/// Fewer burned out cells inside the fire than this say nothing of the others.
constexpr std::size_t enough_cells = 10;
constexpr double least_share = 0.02;
constexpr double least_delay = 1.0; ///< s
/// Standard deviations as parts of what they belong to: crossing, delay, and a cell's heat.
constexpr double ragged = 0.8, uneven_fuel = 0.5, uneven_heat = 0.25;
constexpr std::size_t heat_reach = 2; ///< cells around one that tell how much heat a cell gives

double square(double value) {
  return value * value;
}

/// Part of its heat that a cell has released `age` s after the front came, which takes `crossing` s
/// across it; each spot of it burns as exp(-age / delay) (Mandel et al. 2011, eq. 3).
double released(double age, double crossing, double delay) {
  const double lit = std::min(age, crossing);
  return (lit - delay * (std::exp(-(age - lit) / delay) - std::exp(-age / delay))) / crossing;
}

/// The crossing with which a cell has released so much; 0 where no front is that fast.
double crossing_by_heat(double age, double part, double delay) {
  if (released(age, age, delay) >= part) { // the front is still in it, or has just left
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

  /// Values at a time stand for it; means, for the middle of what they are a mean of.
  static double half_mean(const run::Run& run, double interval) {
    return 0.5 * std::min(run.description().mean_s.value_or(interval), interval);
  }

  double usual_interval() const {
    return times_.size() > 1 ? (times_.back() - times_.front()) / double(times_.size() - 1) : 0.0;
  }

  double last_interval() const {
    return times_.size() > 1 ? times_.back() - times_[times_.size() - 2] : 0.0;
  }

  /// J/m2 of a cell until the end of the run. The sum by trapezoids counts half of the last flux,
  /// which is right for values at their times; of a mean it lacks the other half.
  double heat_so_far(std::size_t i) const {
    return cells_[i].heat + half_last_ * double{cells_[i].last};
  }

  /// kg/m2 that heat goes by; where that is not known all cells count alike.
  double fuel(std::size_t i) const { return fuel_.empty() ? 1.0 : fuel_[i]; }

  /// Mean time of a cell's heat, s.
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

  /// Whether the cells around burn too: then the front has gone right through it.
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
      delay_ = std::max(median(delays), least_delay);
    }
  }

  /// Part of a cell that its heat, up to now, stands for.
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
    return std::clamp(heat_so_far(i) / (usual * fuel(i)), least_share, 1.0);
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

  /// What the slopes in and around a cell say of its crossing at most, s.
  double wide_crossing(std::size_t i) const {
    double sum = 0.0, count = 0.0;
    around(i, 1, [&](std::size_t k) {
      sum += burns(k) ? crossing_[k] : 0.0;
      count += burns(k) ? 1.0 : 0.0;
    });
    return std::max(crossing_[i], sum / count);
  }

  /// From a cell's beginning to its middle, and the standard deviation of that, s.
  using TimeIn = std::pair<double, double>;

  /// The mean time of its heat is that of the share that burned, at the same pace over all of it.
  TimeIn by_mean_time(std::size_t i) const {
    const double found = std::max(heat_time(i) - *delay_ - begin_[i], 0.0) / share(i);
    return {found, std::hypot(uneven_fuel * *delay_, uneven_heat * found)};
  }

  /// The front is as far as its heat tells, give or take what cells differ in heat and in delay.
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

  /// What burns from the beginning: the outermost cells then, those within earlier at a usual pace.
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
    for (std::size_t i = 0; i < cells_.size(); ++i) { // where all of the grid burns
      if (cells_[i].first == 0 && std::isnan(result.time[i])) {
        result.time[i] = times_.front();
      }
    }
  }

  /// One cell beyond the fire, at the pace of the cells beside it.
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
  std::vector<double> crossing_; ///< s, by the slope of begin_
  std::vector<double> fuel_;     ///< kg/m2, empty where it is not known
  double half_mean_, half_last_; ///< s, of all fluxes and of the last
  std::vector<bool> whole_;      ///< burned out, and burning cells on all sides
  double heat_ = 0.0;            ///< J/kg, median of the whole ones
  std::optional<double> delay_;  ///< s from arrival to heat, where enough cells tell
};

} // namespace

FrontPassage front_passage_from_flux(const run::Run& run) {
  return Estimator(run).middle();
}

} // namespace firetwin::flux
