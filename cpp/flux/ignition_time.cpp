#include "flux/ignition_time.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace firetwin::flux {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Cells; a front that moves farther in an interval gives no information about the cells in
/// between.
constexpr std::ptrdiff_t max_band_width = 32;

struct Estimate {
  double time; ///< s
  double variance;

  Estimate averaged(const Estimate& other) const {
    if (std::isinf(other.variance)) {
      return *this;
    }
    const double weight = variance / (variance + other.variance);
    return {time + weight * (other.time - time), weight * other.variance};
  }
};

/// Interval between two model times in which a cell ignites.
struct Interval {
  double begin;
  double end;
  double length() const { return end - begin; }
  double middle() const { return 0.5 * (begin + end); }
  double variance() const { return length() * length() / 12.0; }
};

/// Time since ignition from the first two fluxes, `gap` apart; each is a mean over `mean[i]`
/// seconds (see ignition_time.hpp).
double grown(double first, double next, double gap, const std::array<double, 2>& mean) {
  const double r = first / next, a = mean[0], later = gap - 0.5 * mean[1];
  const double within = a * r + std::sqrt(a * r * (a * r + 2.0 * later));
  return within < a ? within : (0.5 * a + r * later) / (1.0 - r);
}

/// Ignition data of all cells.
class Cells {
public:
  explicit Cells(const run::Run& run)
      : scan_(run.scan().cells), times_(run.times()),
        mean_(run.description().mean_s.value_or(infinity)), rows_(run.latitude().size()),
        columns_(run.longitude().size()), middle_(scan_.size(), nan), begun_(times_.size() + 1, 0) {
    for (std::size_t i = 0; i < scan_.size(); ++i) {
      const std::size_t first = std::min<std::size_t>(scan_[i].first, times_.size());
      ++begun_[first];
      middle_[i] = first > 0 && first < times_.size() ? interval(i).middle() : nan;
    }
    for (std::size_t i = 1; i < begun_.size(); ++i) {
      begun_[i] += begun_[i - 1];
    }
  }

  double time(std::size_t cell) const {
    const std::uint32_t first = scan_[cell].first;
    if (first == run::Scan::never || first == 0) {
      return first == 0 ? times_.front() : nan;
    }
    const Interval at = interval(cell);
    const Estimate found =
        from_front(cell, at).averaged(from_growth(cell, at)).averaged(from_band(cell, at));
    return std::clamp(found.time, at.begin, at.end);
  }

private:
  Interval interval(std::size_t cell) const {
    const std::uint32_t first = scan_[cell].first;
    return {times_[first - 1], times_[first]};
  }

  Estimate from_growth(std::size_t cell, const Interval& at) const {
    const run::Scan::Cell& c = scan_[cell];
    const double d = at.length();
    const double gap = c.first + 1 < times_.size() ? times_[c.first + 1] - times_[c.first] : 0.0;
    const std::array<double, 2> means = {std::min(mean_, d), std::min(mean_, gap)};
    const double s = c.next > c.flux ? grown(double{c.flux}, double{c.next}, gap, means) : d;
    return s < d ? Estimate{at.end - s, 0.04 * d * d} : Estimate{at.middle(), at.variance()};
  }

  Estimate from_front(std::size_t i, const Interval& at) const {
    const std::size_t y = i / columns_, x = i % columns_;
    double sum = middle_[i], weight = 1.0, spread = 0.0;
    const auto add = [&](std::size_t step) {
      const double mean = 0.5 * (middle_[i - step] + middle_[i + step]);
      const bool tells = middle_[i - step] != middle_[i] || middle_[i + step] != middle_[i];
      if (std::isfinite(mean) && tells) {
        sum += 2.0 * mean;
        weight += 2.0;
        // The mean of two values minus a third has 1.5 times the variance of each.
        spread += (mean - middle_[i]) * (mean - middle_[i]) / 1.5;
      }
    };
    const bool inner_x = x > 0 && x + 1 < columns_;
    const bool inner_y = y > 0 && y + 1 < rows_;
    if (inner_x) {
      add(1);
    }
    if (inner_y) {
      add(columns_);
    }
    if (inner_x && inner_y) {
      add(columns_ + 1);
      add(columns_ - 1);
    }
    const double pairs = (weight - 1.0) / 2.0;
    const double variance = std::max(pairs > 0.0 ? spread / pairs : 0.0, at.variance());
    return {sum / weight, variance / weight};
  }

  Estimate from_band(std::size_t cell, const Interval& at) const {
    const std::uint32_t first = scan_[cell].first;
    const bool closed = begun_[first - 1] > 0 && begun_[first] < scan_.size();
    const auto [to_burned, to_unburned] =
        closed ? distances(cell, first) : std::array<double, 2>{infinity, infinity};
    const double width = to_burned + to_unburned - 1.0;
    if (!std::isfinite(width)) {
      return {at.middle(), infinity};
    }
    return {at.begin + at.length() * (to_burned - 0.5) / width, at.variance() / (width * width)};
  }

  /// Distances in cells to the nearest cell that ignited before the time index `first`, and to the
  /// nearest that ignited after.
  std::array<double, 2> distances(std::size_t cell, std::uint32_t first) const {
    const auto y = static_cast<std::ptrdiff_t>(cell / columns_);
    const auto x = static_cast<std::ptrdiff_t>(cell % columns_);
    std::array<double, 2> square = {infinity, infinity};
    for (std::ptrdiff_t r = 1; r <= max_band_width; ++r) {
      if (static_cast<double>(r * r) >= std::max(square[0], square[1])) {
        break;
      }
      for (std::ptrdiff_t dy = -r; dy <= r; ++dy) {
        const std::ptrdiff_t step = std::abs(dy) == r ? 1 : 2 * r;
        for (std::ptrdiff_t dx = -r; dx <= r; dx += step) {
          look(y + dy, x + dx, static_cast<double>(dy * dy + dx * dx), first, square);
        }
      }
    }
    return {std::sqrt(square[0]), std::sqrt(square[1])};
  }

  void look(std::ptrdiff_t y, std::ptrdiff_t x, double square, std::uint32_t first,
            std::array<double, 2>& least) const {
    if (y < 0 || x < 0 || y >= static_cast<std::ptrdiff_t>(rows_) ||
        x >= static_cast<std::ptrdiff_t>(columns_)) {
      return;
    }
    const std::uint32_t other =
        scan_[static_cast<std::size_t>(y) * columns_ + static_cast<std::size_t>(x)].first;
    if (other != first) {
      double& nearest = least[other < first ? 0 : 1];
      nearest = std::min(nearest, square);
    }
  }

  const std::vector<run::Scan::Cell>& scan_;
  const std::vector<double>& times_;
  double mean_; ///< averaging interval of a flux, s
  std::size_t rows_, columns_;
  std::vector<double> middle_;     ///< centre of each cell's interval; NaN without one
  std::vector<std::size_t> begun_; ///< number of ignited cells at each model time
};

} // namespace

std::vector<double> ignition_time_from_flux(const run::Run& run) {
  const Cells cells(run);
  std::vector<double> result(run.cells());
  tbb::parallel_for(std::size_t{0}, result.size(),
                    [&](std::size_t i) { result[i] = cells.time(i); });
  return result;
}

} // namespace firetwin::flux
