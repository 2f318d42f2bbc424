#include "tiles/ground.hpp"

#include "tiles/connected_components.hpp"
#include "tiles/opening.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace firetwin::tiles {
namespace {

using Mask = std::vector<std::uint8_t>;

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t edge_width = 2;      // points
constexpr std::size_t min_roof_points = 2; // number of points of a smooth surface that make a roof

/// Mask of points that an opening lowers by more than its threshold. Opens `surface` in place.
Mask find_objects(std::vector<float>& surface, std::size_t rows, std::size_t columns,
                  const GroundOptions& options) {
  Mask found(surface.size(), 0);
  for (std::size_t radius = 1, before = 0;; before = radius, radius *= 2) {
    const double wider = 2.0 * static_cast<double>(radius - before) * options.step;
    const auto threshold =
        static_cast<float>(std::min(options.min_height + options.slope * wider,
                                    std::max(options.max_threshold, options.slope * wider)));
    const auto lower = morphological_opening(surface, rows, columns, radius);
    for (std::size_t k = 0; k < surface.size(); ++k) {
      if (surface[k] - lower[k] > threshold) { // false for NaN
        found[k] = 1;
      }
    }
    surface = lower;
    if (static_cast<double>(2 * radius + 1) * options.step >= options.max_width) {
      return found;
    }
  }
}

/// Adds points next to objects that rise above the opened surface: thin edges of crowns.
void add_edges(Mask& found, std::span<const float> height, std::span<const float> opened,
               std::size_t rows, std::size_t columns, double least) {
  const auto near = dilate(found, rows, columns, edge_width);
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (near[k] && height[k] - opened[k] > static_cast<float>(least)) {
      found[k] = 1;
    }
  }
}

/// Removes components whose sides are not steep on average.
void keep_steep(Mask& found, std::span<const float> height, const ConnectedComponents& patches,
                const GroundOptions& options) {
  std::vector<double> rise(patches.count, 0.0);
  std::vector<std::size_t> sides(patches.count, 0);
  for_each_pair(patches.rows, patches.columns, [&](std::size_t a, std::size_t b) {
    if (found[a] != found[b] && !std::isnan(height[a]) && !std::isnan(height[b])) {
      const auto patch = static_cast<std::size_t>(patches.number[found[a] ? a : b]);
      rise[patch] += static_cast<double>(found[a] ? height[a] - height[b] : height[b] - height[a]);
      ++sides[patch];
    }
  });
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found[k]) {
      const auto patch = static_cast<std::size_t>(patches.number[k]);
      found[k] =
          rise[patch] >= options.min_side_slope * options.step * static_cast<double>(sides[patch]);
    }
  }
}

/// Interpolates ground heights below objects: the mean of linear interpolations along rows and
/// columns, weighted by the inverse square of the gap.
class GapInterpolator {
public:
  explicit GapInterpolator(std::size_t count) : sum_(count, 0.0F), weight_(count, 0.0F) {}

  void fill_line(const Mask& object, std::span<const float> height, std::size_t first,
                 std::size_t count, std::size_t between) {
    const auto at = [&](std::size_t k) { return first + k * between; };
    for (std::size_t k = 0; k < count;) {
      if (!object[at(k)]) {
        ++k;
        continue;
      }
      std::size_t end = k;
      while (end < count && object[at(end)]) {
        ++end;
      }
      const float from = k > 0 ? height[at(k - 1)] : unknown;
      const float to = end < count ? height[at(end)] : unknown;
      const auto gap = static_cast<float>(end - k + 1);
      for (std::size_t m = k; m < end; ++m) {
        add(at(m), from, to, static_cast<float>(m - k + 1) / gap, gap);
      }
      k = end;
    }
  }

  float height(std::size_t k, float otherwise) const {
    return weight_[k] > 0.0F ? sum_[k] / weight_[k] : otherwise;
  }

private:
  void add(std::size_t k, float from, float to, float part, float gap) {
    const bool both = !std::isnan(from) && !std::isnan(to);
    if (!both && std::isnan(from) && std::isnan(to)) {
      return;
    }
    const float value = both ? from + part * (to - from) : std::isnan(from) ? to : from;
    const float weight =
        (both ? 1.0F : 0.01F) / (gap * gap); // low weight: ground on one side gives no slope
    sum_[k] += weight * value;
    weight_[k] += weight;
  }

  std::vector<float> sum_, weight_;
};

/// Mask of roofs: points of objects with little curvature and slope, in components that are large
/// enough.
Mask find_roofs(const Mask& object, std::span<const float> height, std::size_t rows,
                std::size_t columns, const GroundOptions& options) {
  Mask even(object.size(), 0);
  const auto most = static_cast<float>(options.max_roof_bend * options.step);
  const auto steepest = static_cast<float>(2.0 * options.max_roof_slope * options.step);
  for (std::size_t y = 1; y + 1 < rows; ++y) {
    for (std::size_t x = 1; x + 1 < columns; ++x) {
      const std::size_t k = y * columns + x;
      bool flat = object[k] != 0;
      for (const std::size_t away : {std::size_t{1}, columns}) {
        flat = flat && object[k - away] && object[k + away] &&
               std::abs(height[k - away] - 2.0F * height[k] + height[k + away]) <= most &&
               std::abs(height[k + away] - height[k - away]) <= steepest;
      }
      even[k] = flat;
    }
  }
  Mask joined = dilate(even, rows, columns, 1); // joins the two sides of a ridge
  for (std::size_t k = 0; k < even.size(); ++k) {
    joined[k] = joined[k] && object[k];
  }
  const auto patches = label_components(joined, rows, columns);
  std::vector<std::size_t> count(patches.count, 0);
  for (std::size_t k = 0; k < even.size(); ++k) {
    if (even[k]) {
      ++count[static_cast<std::size_t>(patches.number[k])];
    }
  }
  for (std::size_t k = 0; k < even.size(); ++k) {
    even[k] = even[k] && count[static_cast<std::size_t>(patches.number[k])] >= min_roof_points;
  }
  return even;
}

} // namespace

Ground find_ground(std::span<const float> height, std::size_t rows, std::size_t columns,
                   const GroundOptions& options) {
  if (!(options.step > 0.0) || !(options.max_width > 0.0) || height.size() != rows * columns) {
    throw std::invalid_argument(
        "step and max_width must be above 0, and height must have rows x columns values");
  }
  std::vector<float> opened(height.begin(), height.end());
  Mask object = find_objects(opened, rows, columns, options);
  add_edges(object, height, opened, rows, columns, options.min_height);
  keep_steep(object, height, label_components(object, rows, columns), options);
  GapInterpolator gaps(height.size());
  for (std::size_t row = 0; row < rows; ++row) {
    gaps.fill_line(object, height, row * columns, columns, 1);
  }
  for (std::size_t column = 0; column < columns; ++column) {
    gaps.fill_line(object, height, column, rows, columns);
  }
  const Mask roof = dilate(find_roofs(object, height, rows, columns, options), rows, columns, 2);
  Ground ground{{height.begin(), height.end()},
                std::vector<SurfaceClass>(height.size(), SurfaceClass::ground)};
  for (std::size_t k = 0; k < height.size(); ++k) {
    if (object[k]) {
      ground.height[k] = std::min(gaps.height(k, opened[k]), height[k]);
      ground.surface_class[k] = roof[k] ? SurfaceClass::building : SurfaceClass::vegetation;
    }
  }
  return ground;
}

} // namespace firetwin::tiles
