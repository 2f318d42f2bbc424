#include "flux/arrival.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace firetwin::flux {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Estimate {
  double time;
  double variance;
};

/// The interval between two model times in which a cell begins to burn.
struct Interval {
  double begin;
  double end;
  double length() const { return end - begin; }
  double middle() const { return 0.5 * (begin + end); }
  double variance() const { return length() * length() / 12.0; }
};

/// Time since the beginning from the first two fluxes, `gap` apart. Each is a mean over its
/// `mean[i]` seconds: see arrival.hpp.
double grown(double first, double next, double gap, const std::array<double, 2>& mean) {
  const double r = first / next, a = mean[0], later = gap - 0.5 * mean[1];
  const double within = a * r + std::sqrt(a * r * (a * r + 2.0 * later));
  return within < a ? within : (0.5 * a + r * later) / (1.0 - r);
}

Estimate from_growth(double first, double next, const Interval& at, double gap, double mean) {
  const double d = at.length();
  const std::array<double, 2> means = {std::min(mean, d), std::min(mean, gap)};
  const double s = next > first ? grown(first, next, gap, means) : d;
  return s < d ? Estimate{at.end - s, 0.04 * d * d} : Estimate{at.middle(), at.variance()};
}

/// @param middle [rows columns] middle of the interval of each cell, NaN where it has none
Estimate from_front(const std::vector<double>& middle, std::size_t columns, std::size_t y,
                    std::size_t x, const Interval& at) {
  const std::size_t rows = middle.size() / columns;
  const std::size_t i = y * columns + x;
  double sum = middle[i], weight = 1.0, spread = 0.0;
  const auto add = [&](std::size_t step) {
    const double mean = 0.5 * (middle[i - step] + middle[i + step]);
    const bool tells = middle[i - step] != middle[i] || middle[i + step] != middle[i];
    if (std::isfinite(mean) && tells) {
      sum += 2.0 * mean;
      weight += 2.0;
      // The mean of two less a third has 1.5 times the variance of each.
      spread += (mean - middle[i]) * (mean - middle[i]) / 1.5;
    }
  };
  const bool inner_x = x > 0 && x + 1 < columns;
  const bool inner_y = y > 0 && y + 1 < rows;
  if (inner_x) {
    add(1);
  }
  if (inner_y) {
    add(columns);
  }
  if (inner_x && inner_y) {
    add(columns + 1);
    add(columns - 1);
  }
  const double pairs = (weight - 1.0) / 2.0;
  const double variance = std::max(pairs > 0.0 ? spread / pairs : 0.0, at.variance());
  return {sum / weight, variance / weight};
}

class Cells {
public:
  explicit Cells(const run::Run& run)
      : times_(run.times()), index_(run.cells(), 0), middle_(run.cells(), nan) {
    const std::vector<float> plain = run.arrival_time(0.0);
    const std::vector<float> times(times_.begin(), times_.end());
    for (std::size_t i = 0; i < index_.size(); ++i) {
      if (!std::isnan(plain[i])) {
        const auto found = std::lower_bound(times.begin(), times.end(), plain[i]);
        index_[i] = static_cast<std::size_t>(found - times.begin());
        middle_[i] = index_[i] > 0 ? interval(i).middle() : nan;
      }
    }
  }

  /// Cells that begin between two model times.
  bool has_interval(std::size_t cell) const { return index_[cell] > 0; }
  std::size_t index(std::size_t cell) const { return index_[cell]; }
  Interval interval(std::size_t cell) const {
    return {times_[index_[cell] - 1], times_[index_[cell]]};
  }

  /// The time of a cell that has an interval: the mean of both estimates.
  Beginning beginning(std::size_t cell, std::size_t columns, const Estimate& growth) const {
    const Interval at = interval(cell);
    const Estimate front = from_front(middle_, columns, cell / columns, cell % columns, at);
    const double weight = front.variance / (front.variance + growth.variance);
    const double time = front.time + weight * (growth.time - front.time);
    return {cell, std::clamp(time, at.begin, at.end), weight * growth.variance};
  }

private:
  const std::vector<double>& times_;
  std::vector<std::size_t>
      index_; ///< of the first model time with flux, 0 also where there is none
  std::vector<double> middle_;
};

/// Seconds over which a flux is a mean.
double mean_of(const run::Run& run, bool averaged) {
  constexpr double whole_interval = std::numeric_limits<double>::infinity();
  return averaged ? run.description().mean_s.value_or(whole_interval) : 0.0;
}

/// Reads pairs of successive frames, each frame once where the pairs follow each other.
class Pairs {
public:
  explicit Pairs(const run::Run& run)
      : series_(run.heat_flux()), now_(run.cells()), next_(run.cells()), held_(series_.size()) {}

  /// Both are the last frame where there is none after it: nothing has grown.
  void read(std::size_t index) {
    if (held_ == index) {
      now_.swap(next_);
    } else {
      series_.read(index, now_);
    }
    held_ = std::min(index + 1, series_.size() - 1);
    series_.read(held_, next_);
  }

  double now(std::size_t cell) const { return double{now_[cell]}; }
  double next(std::size_t cell) const { return double{next_[cell]}; }

private:
  const run::Series& series_;
  std::vector<float> now_, next_;
  std::size_t held_; ///< the time whose flux `next_` holds
};

/// Times of the `found` cells, all of which begin before the same model time `index`.
void add_times(const run::Run& run, const Cells& cells, bool averaged, Pairs& pairs,
               std::size_t index, std::span<Beginning> found) {
  if (found.empty()) {
    return;
  }
  pairs.read(index);
  const std::vector<double>& times = run.times();
  const double gap = index + 1 < times.size() ? times[index + 1] - times[index] : 0.0;
  for (Beginning& b : found) {
    const Estimate growth = from_growth(pairs.now(b.cell), pairs.next(b.cell),
                                        cells.interval(b.cell), gap, mean_of(run, averaged));
    b = cells.beginning(b.cell, run.longitude().size(), growth);
  }
}

} // namespace

std::vector<float> arrival_time(const run::Run& run, bool averaged) {
  const Cells cells(run);
  std::vector<std::vector<Beginning>> starting(run.times().size());
  for (std::size_t i = 0; i < run.cells(); ++i) {
    if (cells.has_interval(i)) {
      starting[cells.index(i)].push_back({i, nan, nan});
    }
  }
  using Range = tbb::blocked_range<std::size_t>;
  tbb::parallel_for(Range(0, starting.size(), 32), [&](const Range& range) {
    Pairs pairs(run);
    for (std::size_t t = range.begin(); t < range.end(); ++t) {
      add_times(run, cells, averaged, pairs, t, starting[t]);
    }
  });
  std::vector<float> result = run.arrival_time(0.0);
  for (const std::vector<Beginning>& found : starting) {
    for (const Beginning& b : found) {
      result[b.cell] = static_cast<float>(b.time);
    }
  }
  return result;
}

std::vector<Beginning> beginnings(const run::Run& run, std::size_t index, bool averaged) {
  const Cells cells(run);
  std::vector<Beginning> found;
  for (std::size_t i = 0; i < run.cells(); ++i) {
    if (cells.has_interval(i) && cells.index(i) == index) {
      found.push_back({i, nan, nan});
    }
  }
  Pairs pairs(run);
  add_times(run, cells, averaged, pairs, index, found);
  return found;
}

} // namespace firetwin::flux
