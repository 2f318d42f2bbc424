#include "geo/height_field.hpp"

#include "geo/axis.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

namespace firetwin::geo {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns true for a descending axis. @throws std::invalid_argument
bool check_axis(std::span<const double> axis, const std::string& name) {
  const auto not_finite = [](double v) { return !std::isfinite(v); };
  if (axis.size() < 2 || std::any_of(axis.begin(), axis.end(), not_finite)) {
    throw std::invalid_argument(name + " must have at least two finite values");
  }
  const bool descends = axis[1] < axis[0];
  for (std::size_t i = 1; i < axis.size(); ++i) {
    if (!(descends ? axis[i] < axis[i - 1] : axis[i] > axis[i - 1])) {
      throw std::invalid_argument(name + " must ascend or descend throughout, without duplicates");
    }
  }
  return descends;
}

double smallest_step(const std::vector<double>& axis) {
  double least = infinity;
  for (std::size_t i = 1; i < axis.size(); ++i) {
    least = std::min(least, axis[i] - axis[i - 1]);
  }
  return least;
}

} // namespace

HeightField::HeightField(std::span<const double> x, std::span<const double> y,
                         std::span<const float> height)
    : x_(x.begin(), x.end()), y_(y.begin(), y.end()), height_(height.begin(), height.end()),
      highest_(-infinity) {
  if (check_axis(x, "x")) {
    std::reverse(x_.begin(), x_.end());
    for (auto row = height_.begin(); row != height_.end(); row += std::ssize(x_)) {
      std::reverse(row, row + std::ssize(x_));
    }
  }
  if (check_axis(y, "y")) {
    std::reverse(y_.begin(), y_.end());
    const std::ptrdiff_t n = std::ssize(x_);
    for (std::ptrdiff_t low = 0, high = std::ssize(y_) - 1; low < high; ++low, --high) {
      std::swap_ranges(height_.begin() + low * n, height_.begin() + (low + 1) * n,
                       height_.begin() + high * n);
    }
  }
  for (float& h : height_) {
    h = std::isfinite(h) ? h : std::numeric_limits<float>::quiet_NaN();
    highest_ = h > highest_ ? double{h} : highest_;
  }
  smallest_cell_ = std::min(smallest_step(x_), smallest_step(y_));
}

double HeightField::at(double x, double y) const {
  return bilinear(height_, x_.size(), bracket(y_, y), bracket(x_, x));
}

} // namespace firetwin::geo
