#include "flux/crossing_time.hpp"

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

template <class T> double crossing(std::span<const T> time, std::size_t columns, std::size_t cell) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const double here = double{time[cell]};
  if (std::isnan(here)) {
    return 0.0;
  }
  const std::size_t x = cell % columns;
  const auto at = [&](bool inside, std::size_t index) {
    return inside ? double{time[index]} : nan;
  };
  return along(at(x > 0, cell - 1), here, at(x + 1 < columns, cell + 1)) +
         along(at(cell >= columns, cell - columns), here,
               at(cell + columns < time.size(), cell + columns));
}

} // namespace

double crossing_time(std::span<const float> time, std::size_t columns, std::size_t cell) {
  return crossing(time, columns, cell);
}

double crossing_time(std::span<const double> time, std::size_t columns, std::size_t cell) {
  return crossing(time, columns, cell);
}

std::vector<double> crossing_time(std::span<const double> time, std::size_t columns) {
  std::vector<double> result(time.size());
  tbb::parallel_for(std::size_t{0}, time.size() / columns, [&](std::size_t y) {
    for (std::size_t i = y * columns; i < (y + 1) * columns; ++i) {
      result[i] = crossing(time, columns, i);
    }
  });
  return result;
}

} // namespace firetwin::flux
