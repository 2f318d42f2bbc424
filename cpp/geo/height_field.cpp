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

/// Whether the axis descends. @throws std::invalid_argument
bool check_axis(std::span<const double> axis, const std::string& name) {
  const auto not_finite = [](double v) { return !std::isfinite(v); };
  if (axis.size() < 2 || std::any_of(axis.begin(), axis.end(), not_finite)) {
    throw std::invalid_argument(name + " must hold two or more finite places");
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

/// The cell of an ascending axis that holds `value`, which lies within the axis.
std::size_t cell_of(const std::vector<double>& axis, double value) {
  const auto next = std::upper_bound(axis.begin() + 1, axis.end() - 1, value);
  return static_cast<std::size_t>(next - axis.begin()) - 1;
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
  build_blocks();
}

void HeightField::build_blocks() {
  const std::size_t nx = x_.size();
  Blocks cells{y_.size() - 1, nx - 1, {}};
  cells.lowest.resize(cells.rows * cells.columns);
  for (std::size_t r = 0; r < cells.rows; ++r) {
    for (std::size_t c = 0; c < cells.columns; ++c) {
      const float* h = &height_[r * nx + c];
      const bool whole = std::isfinite(h[0] + h[1] + h[nx] + h[nx + 1]);
      cells.lowest[r * cells.columns + c] = whole ? std::min({h[0], h[1], h[nx], h[nx + 1]})
                                                  : -std::numeric_limits<float>::infinity();
    }
  }
  blocks_.push_back(std::move(cells));
  while (blocks_.back().rows > 1 || blocks_.back().columns > 1) {
    const Blocks& fine = blocks_.back();
    Blocks coarse{(fine.rows + 1) / 2, (fine.columns + 1) / 2, {}};
    coarse.lowest.assign(coarse.rows * coarse.columns, std::numeric_limits<float>::infinity());
    for (std::size_t r = 0; r < fine.rows; ++r) {
      for (std::size_t c = 0; c < fine.columns; ++c) {
        float& low = coarse.lowest[r / 2 * coarse.columns + c / 2];
        low = std::min(low, fine.lowest[r * fine.columns + c]);
      }
    }
    blocks_.push_back(std::move(coarse));
  }
}

double HeightField::at(double x, double y) const {
  return bilinear(height_, x_.size(), bracket(y_, y), bracket(x_, x));
}

double HeightField::lowest(double x, double y, double half) const {
  if (!(x - half >= x_.front() && x + half <= x_.back() && y - half >= y_.front() &&
        y + half <= y_.back())) {
    return -infinity;
  }
  std::size_t left = cell_of(x_, x - half), right = cell_of(x_, x + half);
  std::size_t low = cell_of(y_, y - half), high = cell_of(y_, y + half);
  std::size_t k = 0;
  for (; right - left > 1 || high - low > 1; ++k) {
    left /= 2, right /= 2, low /= 2, high /= 2;
  }
  const Blocks& blocks = blocks_[k];
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t r = low; r <= high; ++r) {
    for (std::size_t c = left; c <= right; ++c) {
      least = std::min(least, blocks.lowest[r * blocks.columns + c]);
    }
  }
  return double{least};
}

} // namespace firetwin::geo
