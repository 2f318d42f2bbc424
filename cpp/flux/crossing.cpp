#include "flux/crossing.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace firetwin::flux {
namespace {

double along(double before, double here, double after) {
  const double back = std::abs(here - before), ahead = std::abs(after - here);
  const double least = std::fmin(back, ahead);
  if (std::isnan(least)) {
    return 0.0;
  }
  const double mean = 0.5 * (back + ahead);
  return std::isnan(mean) ? least : std::min(mean, 2.0 * least);
}

} // namespace

std::vector<double> crossing_time(const std::vector<double>& time, std::size_t columns) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const std::size_t rows = time.size() / columns;
  std::vector<double> result(time.size());
  tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t y) {
    for (std::size_t x = 0; x < columns; ++x) {
      const std::size_t i = y * columns + x;
      result[i] =
          along(x > 0 ? time[i - 1] : nan, time[i], x + 1 < columns ? time[i + 1] : nan) +
          along(y > 0 ? time[i - columns] : nan, time[i], y + 1 < rows ? time[i + columns] : nan);
    }
  });
  return result;
}

} // namespace firetwin::flux
