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

constexpr int max_depth = 10;       // bisections of a cell
constexpr double full_detail = 0.6; // fraction of the radius with full detail

void check(const MeshInput& input, const NearDetail& detail) {
  const std::size_t count = input.rows * input.columns;
  if (input.rows < 2 || input.columns < 2) {
    throw std::invalid_argument("place must have at least two rows and columns");
  }
  if (input.place.size() != 3 * count || input.tolerance.size() != count) {
    throw std::invalid_argument(
        "place and tolerance must have the same number of rows and columns");
  }
  const auto finite = [](float value) { return std::isfinite(value); };
  if (!std::all_of(input.place.begin(), input.place.end(), finite)) {
    throw std::invalid_argument("place must be finite");
  }
  if (!std::all_of(input.tolerance.begin(), input.tolerance.end(),
                   [](float value) { return value >= 0.0F; })) {
    throw std::invalid_argument("tolerance must be 0 or more");
  }
  if (!input.subdivision.empty() &&
      input.subdivision.size() != (input.rows - 1) * (input.columns - 1)) {
    throw std::invalid_argument("subdivision must have one row and column fewer than place");
  }
  if (detail.surface &&
      (detail.surface->rows() != input.rows || detail.surface->columns() != input.columns)) {
    throw std::invalid_argument("surface must have the same number of rows and columns as place");
  }
}

} // namespace

Points::Points(const MeshInput& input, const NearDetail& detail) : input_(input), detail_(detail) {
  check(input, detail);
  depth_ = input.subdivision.empty()
               ? 0
               : *std::max_element(input.subdivision.begin(), input.subdivision.end());
  const std::size_t most = std::size_t{1} << (30 - std::min(depth_, 30));
  if (depth_ > max_depth || std::max(input.rows, input.columns) > most) {
    throw std::invalid_argument("the grid has too many points");
  }
  width_ = static_cast<std::int32_t>(input.columns - 1) << depth_;
  height_ = static_cast<std::int32_t>(input.rows - 1) << depth_;
  if (detail_.camera.empty() || detail_.radius <= 0.0) {
    detail_.surface = nullptr;
  }
  if (detail_.surface) {
    for (int axis = 0; axis < 2; ++axis) {
      double& low = box_[2 * axis] = std::numeric_limits<double>::infinity();
      double& high = box_[2 * axis + 1] = -low;
      for (std::size_t i = static_cast<std::size_t>(axis); i < detail_.camera.size(); i += 3) {
        low = std::min(low, detail_.camera[i] - detail_.radius);
        high = std::max(high, detail_.camera[i] + detail_.radius);
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
  for (std::size_t i = 0; i < detail_.camera.size(); i += 3) {
    const Vector away = minus(p, {detail_.camera[i], detail_.camera[i + 1], detail_.camera[i + 2]});
    nearest = std::min(nearest, dot(away, away));
  }
  return smoothstep(-detail_.radius, -full_detail * detail_.radius, -std::sqrt(nearest));
}

Vector Points::between(std::size_t row, std::size_t column, double v, double u) const {
  const float* first = &input_.place[3 * (row * input_.columns + column)];
  Vector place;
  for (std::size_t k = 0; k < 3; ++k) {
    place[k] = bilinear<ExactLerp>(
        [&](std::size_t j, std::size_t i) {
          return double{first[3 * (j * input_.columns + i) + k]};
        },
        v, u);
  }
  return place;
}

std::vector<Wave> Points::waves() const {
  return detail_.surface ? detail_.surface->waves() : std::vector<Wave>{};
}

Vector Points::at(std::int32_t x, std::int32_t y, std::span<Wave> waves) const {
  const double unit = static_cast<double>(std::int32_t{1} << depth_);
  const std::size_t row = std::min(static_cast<std::size_t>(y >> depth_), input_.rows - 2);
  const std::size_t column = std::min(static_cast<std::size_t>(x >> depth_), input_.columns - 2);
  const double i = y / unit, j = x / unit;
  Vector place =
      between(row, column, i - static_cast<double>(row), j - static_cast<double>(column));
  if (detail_.surface) {
    const double part = weight(place);
    place[2] += part > 0.0 ? part * detail_.surface->detail(i, j, waves) : 0.0;
  }
  return place;
}

void Points::raise_nodes() {
  raised_.resize(input_.rows * input_.columns);
  tbb::parallel_for(std::size_t{0}, input_.rows, [&](std::size_t row) {
    std::vector<Wave> known = waves();
    for (std::size_t column = 0; column < input_.columns; ++column) {
      const std::size_t i = row * input_.columns + column;
      const float* p = &input_.place[3 * i];
      const double part = weight({p[0], p[1], p[2]});
      raised_[i] = part > 0.0 ? static_cast<float>(part * detail_.surface->detail(
                                                              static_cast<double>(row),
                                                              static_cast<double>(column), known))
                              : 0.0F;
    }
  });
}

void Points::fill_tiles() {
  offset_.resize(input_.subdivision.size());
  std::size_t total = 0;
  for (std::size_t cell = 0; cell < offset_.size(); ++cell) {
    offset_[cell] = static_cast<std::uint32_t>(total);
    const std::size_t side = (std::size_t{1} << input_.subdivision[cell]) + 1;
    total += input_.subdivision[cell] > 0 ? side * side : 0;
    if (total > std::numeric_limits<std::uint32_t>::max()) {
      throw std::invalid_argument("the grid has too many points");
    }
  }
  tiles_.resize(total);
  tbb::parallel_for(std::size_t{0}, input_.rows - 1, [&](std::size_t row) {
    std::vector<Wave> known = waves();
    for (std::size_t column = 0; column + 1 < input_.columns; ++column) {
      const std::size_t cell = row * (input_.columns - 1) + column;
      const int level = input_.subdivision[cell];
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

double Points::min_tolerance(std::size_t row, std::size_t column) const {
  const float* low = &input_.tolerance[row * input_.columns + column];
  const float* high = low + input_.columns;
  return double{std::min({low[0], low[1], high[0], high[1]})};
}

} // namespace firetwin::terrain
