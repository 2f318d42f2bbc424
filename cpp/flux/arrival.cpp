#include "flux/arrival.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

/// Time since the beginning from the first two fluxes, `next_interval` apart.
double grown(double first, double next, double interval, double next_interval, bool averaged) {
  const double r = first / next;
  return averaged ? r * interval + std::sqrt(r * interval * (r * interval + next_interval))
                  : r * next_interval / (1.0 - r);
}

Estimate from_growth(double first, double next, const Interval& at, double next_interval,
                     bool averaged) {
  const double d = at.length();
  const double s = next > first ? grown(first, next, d, next_interval, averaged) : d;
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
    if (std::isfinite(mean)) {
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
  const std::vector<double>& middle() const { return middle_; }

private:
  const std::vector<double>& times_;
  std::vector<std::size_t>
      index_; ///< of the first model time with flux, 0 also where there is none
  std::vector<double> middle_;
};

/// Estimates from the growth of each cell's flux; one pass over the frames.
std::vector<Estimate> growths(const run::Run& run, const Cells& cells, bool averaged) {
  const run::Series& series = run.heat_flux();
  const std::vector<double>& times = run.times();
  std::vector<std::vector<std::size_t>> starting(times.size());
  std::vector<Estimate> result(run.cells());
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (cells.has_interval(i)) {
      starting[cells.index(i)].push_back(i);
      result[i] = {cells.interval(i).middle(), cells.interval(i).variance()};
    }
  }
  using Range = tbb::blocked_range<std::size_t>;
  tbb::parallel_for(
      Range(1, std::max<std::size_t>(times.size(), 2) - 1, 32), [&](const Range& range) {
        std::vector<float> now(run.cells()), next(run.cells());
        std::size_t held = times.size(); // the time whose flux `next` holds
        for (std::size_t t = range.begin(); t < range.end(); ++t) {
          if (starting[t].empty()) {
            continue;
          }
          if (held == t) {
            now.swap(next);
          } else {
            series.read(t, now);
          }
          series.read(held = t + 1, next);
          for (const std::size_t i : starting[t]) {
            result[i] = from_growth(double{now[i]}, double{next[i]}, cells.interval(i),
                                    times[t + 1] - times[t], averaged);
          }
        }
      });
  return result;
}

} // namespace

std::vector<float> arrival_time(const run::Run& run, bool averaged) {
  const Cells cells(run);
  const std::vector<Estimate> growth = growths(run, cells, averaged);
  const std::size_t columns = run.longitude().size();
  std::vector<float> result = run.arrival_time(0.0);
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (!cells.has_interval(i)) {
      continue;
    }
    const Interval at = cells.interval(i);
    const Estimate front = from_front(cells.middle(), columns, i / columns, i % columns, at);
    const double weight = front.variance / (front.variance + growth[i].variance);
    const double time = front.time + weight * (growth[i].time - front.time);
    result[i] = static_cast<float>(std::clamp(time, at.begin, at.end));
  }
  return result;
}

} // namespace firetwin::flux
