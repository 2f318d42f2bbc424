#include "terrain/points.hpp"

#include "base/interpolation.hpp"
#include "base/smoothstep.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace firetwin::terrain {
namespace {

constexpr int deepest = 10;   // halvings of a cell
constexpr double whole = 0.6; // of the radius; all detail is there within it

void check(const Survey& survey, const Close& close) {
  const std::size_t count = survey.rows * survey.columns;
  if (survey.rows < 2 || survey.columns < 2) {
    throw std::invalid_argument("place must have two rows and columns or more");
  }
  if (survey.place.size() != 3 * count || survey.tolerance.size() != count) {
    throw std::invalid_argument("place and tolerance must have as many rows and columns");
  }
  const auto finite = [](float value) { return std::isfinite(value); };
  if (!std::all_of(survey.place.begin(), survey.place.end(), finite)) {
    throw std::invalid_argument("place must be finite");
  }
  if (!std::all_of(survey.tolerance.begin(), survey.tolerance.end(),
                   [](float value) { return value >= 0.0F; })) {
    throw std::invalid_argument("tolerance must be 0 or more");
  }
  if (!survey.fine.empty() && survey.fine.size() != (survey.rows - 1) * (survey.columns - 1)) {
    throw std::invalid_argument("fine must have one row and column fewer than place");
  }
  if (close.surface &&
      (close.surface->rows() != survey.rows || close.surface->columns() != survey.columns)) {
    throw std::invalid_argument("surface must have as many rows and columns as place");
  }
}

} // namespace

Points::Points(const Survey& survey, const Close& close) : survey_(survey), close_(close) {
  check(survey, close);
  depth_ = survey.fine.empty() ? 0 : *std::max_element(survey.fine.begin(), survey.fine.end());
  const std::size_t most = std::size_t{1} << (30 - std::min(depth_, 30));
  if (depth_ > deepest || std::max(survey.rows, survey.columns) > most) {
    throw std::invalid_argument("the grid has too many points");
  }
  width_ = static_cast<std::int32_t>(survey.columns - 1) << depth_;
  height_ = static_cast<std::int32_t>(survey.rows - 1) << depth_;
  if (close_.eye.empty() || close_.radius <= 0.0) {
    close_.surface = nullptr;
  }
  if (close_.surface) {
    for (int axis = 0; axis < 2; ++axis) {
      double& low = box_[2 * axis] = std::numeric_limits<double>::infinity();
      double& high = box_[2 * axis + 1] = -low;
      for (std::size_t i = static_cast<std::size_t>(axis); i < close_.eye.size(); i += 3) {
        low = std::min(low, close_.eye[i] - close_.radius);
        high = std::max(high, close_.eye[i] + close_.radius);
      }
    }
    raise_nodes();
  }
  if (depth_ > 0) {
    fill_tiles();
  }
}

double Points::weight(const Vector& p) const {
  if (!(p[0] > box_[0] && p[0] < box_[1] && p[1] > box_[2] && p[1] < box_[3])) {
    return 0.0;
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < close_.eye.size(); i += 3) {
    const Vector away = minus(p, {close_.eye[i], close_.eye[i + 1], close_.eye[i + 2]});
    nearest = std::min(nearest, dot(away, away));
  }
  return smoothstep(-close_.radius, -whole * close_.radius, -std::sqrt(nearest));
}

Vector Points::between(std::size_t row, std::size_t column, double v, double u) const {
  const float* first = &survey_.place[3 * (row * survey_.columns + column)];
  Vector place;
  for (std::size_t k = 0; k < 3; ++k) {
    place[k] = bilinear<ExactLerp>(
        [&](std::size_t j, std::size_t i) {
          return double{first[3 * (j * survey_.columns + i) + k]};
        },
        v, u);
  }
  return place;
}

std::vector<Wave> Points::waves() const {
  return close_.surface ? close_.surface->waves() : std::vector<Wave>{};
}

Vector Points::at(std::int32_t x, std::int32_t y, std::span<Wave> waves) const {
  const double unit = static_cast<double>(std::int32_t{1} << depth_);
  const std::size_t row = std::min(static_cast<std::size_t>(y >> depth_), survey_.rows - 2);
  const std::size_t column = std::min(static_cast<std::size_t>(x >> depth_), survey_.columns - 2);
  const double i = y / unit, j = x / unit;
  Vector place =
      between(row, column, i - static_cast<double>(row), j - static_cast<double>(column));
  if (close_.surface) {
    const double part = weight(place);
    place[2] += part > 0.0 ? part * close_.surface->detail(i, j, waves) : 0.0;
  }
  return place;
}

void Points::raise_nodes() {
  raised_.resize(survey_.rows * survey_.columns);
  tbb::parallel_for(std::size_t{0}, survey_.rows, [&](std::size_t row) {
    std::vector<Wave> known = waves();
    for (std::size_t column = 0; column < survey_.columns; ++column) {
      const std::size_t i = row * survey_.columns + column;
      const float* p = &survey_.place[3 * i];
      const double part = weight({p[0], p[1], p[2]});
      raised_[i] = part > 0.0 ? static_cast<float>(part * close_.surface->detail(
                                                              static_cast<double>(row),
                                                              static_cast<double>(column), known))
                              : 0.0F;
    }
  });
}

void Points::fill_tiles() {
  offset_.resize(survey_.fine.size());
  std::size_t total = 0;
  for (std::size_t cell = 0; cell < offset_.size(); ++cell) {
    offset_[cell] = static_cast<std::uint32_t>(total);
    const std::size_t side = (std::size_t{1} << survey_.fine[cell]) + 1;
    total += survey_.fine[cell] > 0 ? side * side : 0;
    if (total > std::numeric_limits<std::uint32_t>::max()) {
      throw std::invalid_argument("the grid has too many points");
    }
  }
  tiles_.resize(total);
  tbb::parallel_for(std::size_t{0}, survey_.rows - 1, [&](std::size_t row) {
    std::vector<Wave> known = waves();
    for (std::size_t column = 0; column + 1 < survey_.columns; ++column) {
      const std::size_t cell = row * (survey_.columns - 1) + column;
      const int level = survey_.fine[cell];
      const std::int32_t side = (std::int32_t{1} << level) + 1;
      for (std::int32_t j = 0; level > 0 && j < side; ++j) {
        for (std::int32_t i = 0; i < side; ++i) {
          const std::int32_t x =
              (static_cast<std::int32_t>(column) << depth_) + (i << (depth_ - level));
          const std::int32_t y =
              (static_cast<std::int32_t>(row) << depth_) + (j << (depth_ - level));
          tiles_[offset_[cell] + static_cast<std::size_t>(j * side + i)] =
              static_cast<float>(at(x, y, known)[2]);
        }
      }
    }
  });
}

double Points::least_tolerance(std::size_t row, std::size_t column) const {
  const float* low = &survey_.tolerance[row * survey_.columns + column];
  const float* high = low + survey_.columns;
  return double{std::min({low[0], low[1], high[0], high[1]})};
}

} // namespace firetwin::terrain
