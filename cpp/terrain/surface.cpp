#include "terrain/surface.hpp"

#include "base/catmull_rom.hpp"
#include "base/check.hpp"
#include "base/interpolation.hpp"
#include "base/noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace firetwin::terrain {
Wave::Slope Wave::slope(std::int64_t column, std::int64_t row) const {
  const double angle = lattice_hash(column, row, seed_) * (2.0 * std::numbers::pi / 4294967296.0);
  return {std::cos(angle), std::sin(angle)};
}

double Wave::operator()(double x, double y) {
  const double left = std::floor(x), low = std::floor(y);
  const double u = x - left, v = y - low;
  const auto column = static_cast<std::int64_t>(left), row = static_cast<std::int64_t>(low);
  if (!known_ || column != column_ || row != row_) {
    if (known_ && row == row_ && column == column_ + 1) {
      slopes_ = {slopes_[1], slope(column + 1, row), slopes_[3], slope(column + 1, row + 1)};
    } else {
      slopes_ = {slope(column, row), slope(column + 1, row), slope(column, row + 1),
                 slope(column + 1, row + 1)};
    }
    column_ = column;
    row_ = row;
    known_ = true;
  }
  const auto rise = [&](std::size_t j, std::size_t i) {
    const auto [east, north] = slopes_[2 * j + i];
    return east * (u - static_cast<double>(i)) + north * (v - static_cast<double>(j));
  };
  return 1.41 * gradient_noise(rise, v, u);
}

/// Cell of a point, and fractions in it.
struct Surface::Place {
  std::size_t row, column;
  double v, u;

  template <class T> double bilinear(const std::vector<T>& field, std::size_t columns) const {
    const T* first = &field[row * columns + column];
    return firetwin::bilinear<ExactLerp>(
        [&](std::size_t j, std::size_t i) { return double{first[j * columns + i]}; }, v, u);
  }
};

Surface::Surface(Grid<double> elevation, std::vector<float> steep, std::vector<float> dry,
                 double cell_north, double cell_east, Relief relief, Patch patch)
    : elevation_(std::move(elevation)), steep_(std::move(steep)), dry_(std::move(dry)),
      cell_north_(cell_north), cell_east_(cell_east), relief_(std::move(relief)),
      patch_(std::move(patch)) {
  if (elevation_.rows < 2 || elevation_.columns < 2) {
    throw std::invalid_argument("elevation must have at least two rows and columns");
  }
  if (steep_.size() != elevation_.values.size() || dry_.size() != elevation_.values.size()) {
    throw std::invalid_argument("steep and dry must have the shape of elevation");
  }
  const std::size_t points = patch_.rows * patch_.columns;
  if (patch_.offset.size() != points || patch_.share.size() != points || patch_.parts == 0 ||
      (points > 0 && std::min(patch_.rows, patch_.columns) < 2)) {
    throw std::invalid_argument(
        "a patch needs offsets and shares with at least two rows and columns");
  }
  check_above_zero(cell_north_, "cell");
  check_above_zero(cell_east_, "cell");
}

Surface::Place Surface::place(double row, double column, std::size_t rows, std::size_t columns) {
  const auto y = interval_extended(row, static_cast<std::int64_t>(rows));
  const auto x = interval_extended(column, static_cast<std::int64_t>(columns));
  return {static_cast<std::size_t>(y.low), static_cast<std::size_t>(x.low), y.part, x.part};
}

double Surface::smooth(const Place& at) const {
  const auto down = catmull_rom(at.v), across = catmull_rom(at.u);
  const auto held = [](std::size_t index, std::size_t offset, std::size_t count) {
    const std::size_t shifted = index + offset; // one element too many
    return std::min(shifted > 0 ? shifted - 1 : 0, count - 1);
  };
  double total = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double* line = &elevation_.values[held(at.row, i, rows()) * columns()];
    double sum = 0.0;
    for (std::size_t j = 0; j < 4; ++j) {
      sum += across[j] * line[held(at.column, j, columns())];
    }
    total += down[i] * sum;
  }
  return total;
}

std::vector<Wave> Surface::waves() const {
  std::vector<Wave> made;
  for (std::size_t i = 0; i < relief_.octaves.size(); ++i) {
    made.emplace_back(relief_.seed + static_cast<std::int64_t>(i));
  }
  return made;
}

double Surface::relief(const Place& at, double row, double column, std::span<Wave> waves) const {
  const double dry = at.bilinear(dry_, columns());
  if (dry <= 0.0 || relief_.strength <= 0.0) {
    return 0.0;
  }
  const double y = row * cell_north_, x = column * cell_east_;
  double shape = 0.0;
  for (std::size_t i = 0; i < relief_.octaves.size(); ++i) {
    const Octave& octave = relief_.octaves[i];
    const double wave = waves[i](x / octave.size, y / octave.size);
    shape += octave.weight *
             (1.0 - relief_.sharp * std::abs(wave)); // ridged noise: sharp ridges, round hollows
  }
  return relief_.strength * dry * (relief_.level + at.bilinear(steep_, columns())) *
         (shape - relief_.mean);
}

double Surface::detail(double row, double column, std::span<Wave> waves) const {
  const Place at = place(row, column, rows(), columns());
  const auto own = [&] {
    return smooth(at) - at.bilinear(elevation_.values, columns()) + relief(at, row, column, waves);
  };
  if (patch_.rows == 0) {
    return own();
  }
  const double y = (row - static_cast<double>(patch_.row)) * static_cast<double>(patch_.parts);
  const double x =
      (column - static_cast<double>(patch_.column)) * static_cast<double>(patch_.parts);
  if (!(y >= 0.0 && x >= 0.0 && y <= static_cast<double>(patch_.rows - 1) &&
        x <= static_cast<double>(patch_.columns - 1))) {
    return own();
  }
  const Place on = place(y, x, patch_.rows, patch_.columns);
  const double share = on.bilinear(patch_.share, patch_.columns);
  const double known = on.bilinear(patch_.offset, patch_.columns);
  return share >= 1.0 ? known : own() * (1.0 - share) + known * share;
}

} // namespace firetwin::terrain
