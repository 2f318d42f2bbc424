#include "geo/axis.hpp"

#include "base/interpolation.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace firetwin::geo {
namespace {

/// Index of the last interval that starts at or before `value`.
std::size_t interval_of(std::span<const double> axis, double value) {
  const bool ascending = axis.front() < axis.back();
  const auto beyond = [ascending](double v, double node) {
    return ascending ? v < node : v > node;
  };
  const auto next = std::upper_bound(axis.begin() + 1, axis.end() - 1, value, beyond);
  return static_cast<std::size_t>(next - axis.begin()) - 1;
}

std::vector<Bracket> brackets(std::span<const double> axis, std::span<const double> places) {
  std::vector<Bracket> result(places.size());
  std::transform(places.begin(), places.end(), result.begin(),
                 [axis](double place) { return bracket(axis, place); });
  return result;
}

} // namespace

Bracket bracket(std::span<const double> axis, double value) {
  if (axis.size() < 2) {
    return {0, 0, std::isnan(value) ? value : 0.0};
  }
  const std::size_t i = interval_of(axis, value);
  const double fraction = (value - axis[i]) / (axis[i + 1] - axis[i]);
  return {i, i + 1, std::isnan(fraction) ? fraction : std::clamp(fraction, 0.0, 1.0)};
}

std::vector<std::size_t> nearest(std::span<const double> axis, std::span<const double> places) {
  std::vector<std::size_t> result(places.size());
  std::transform(places.begin(), places.end(), result.begin(), [axis](double place) {
    const Bracket at = bracket(axis, place);
    return at.fraction > 0.5 ? at.upper : at.lower;
  });
  return result;
}

Extent cell_extent(std::span<const double> axis, std::size_t index) {
  if (axis.size() < 2) {
    return {axis[index], axis[index]};
  }
  const bool has_previous = index > 0;
  const bool has_next = index + 1 < axis.size();
  const double before = has_previous ? axis[index] - axis[index - 1] : axis[1] - axis[0];
  const double after = has_next ? axis[index + 1] - axis[index] : before;
  return {axis[index] - 0.5 * before, axis[index] + 0.5 * after};
}

namespace {

template <class T>
double between(std::span<const T> values, std::size_t columns, const Bracket& y, const Bracket& x) {
  const std::array<double, 4> corner = {
      double{values[y.lower * columns + x.lower]}, double{values[y.lower * columns + x.upper]},
      double{values[y.upper * columns + x.lower]}, double{values[y.upper * columns + x.upper]}};
  const auto weight = bilinear_weights(y.fraction, x.fraction);
  const std::size_t nearest = (y.fraction > 0.5 ? 2U : 0U) + (x.fraction > 0.5 ? 1U : 0U);
  if (std::isnan(corner[nearest]) || std::isnan(weight[0])) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double sum = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!std::isnan(corner[i]) && weight[i] > 0.0) {
      sum += weight[i] * corner[i];
      total += weight[i];
    }
  }
  return sum / total;
}

} // namespace

double bilinear(std::span<const float> values, std::size_t columns, const Bracket& y,
                const Bracket& x) {
  return between(values, columns, y, x);
}

double bilinear(std::span<const double> values, std::size_t columns, const Bracket& y,
                const Bracket& x) {
  return between(values, columns, y, x);
}

std::vector<float> resample(std::span<const float> values, std::span<const double> from_y,
                            std::span<const double> from_x, std::span<const double> to_y,
                            std::span<const double> to_x) {
  const std::vector<Bracket> rows = brackets(from_y, to_y);
  const std::vector<Bracket> columns = brackets(from_x, to_x);
  std::vector<float> result(to_y.size() * to_x.size());
  tbb::parallel_for(std::size_t{0}, to_y.size(), [&](std::size_t y) {
    for (std::size_t x = 0; x < to_x.size(); ++x) {
      result[y * to_x.size() + x] =
          static_cast<float>(bilinear(values, from_x.size(), rows[y], columns[x]));
    }
  });
  return result;
}

} // namespace firetwin::geo
