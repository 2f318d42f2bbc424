#include "lod/select_nearest.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace firetwin::lod {
namespace {

double squared_distance(const double* a, const double* b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

double nearest(const double* point, std::span<const double> camera) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < camera.size(); c += 3) {
    const double d = squared_distance(point, &camera[c]);
    least = d < least ? d : least; // false for NaN
  }
  return least;
}

} // namespace

std::vector<std::int64_t> select_nearest(std::span<const double> position,
                                         std::span<const double> camera, std::size_t budget) {
  const std::size_t n = position.size() / 3;
  std::vector<double> distance(n);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      distance[i] = nearest(&position[3 * i], camera);
    }
  });
  std::vector<std::int64_t> order(n);
  std::iota(order.begin(), order.end(), std::int64_t{0});
  const auto nearer = [&](std::int64_t a, std::int64_t b) {
    const double da = distance[static_cast<std::size_t>(a)];
    const double db = distance[static_cast<std::size_t>(b)];
    return da != db ? da < db : a < b;
  };
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(budget, n));
  if (end != order.end()) {
    std::nth_element(order.begin(), end, order.end(), nearer);
    order.erase(end, order.end());
  }
  std::sort(order.begin(), order.end(), nearer);
  return order;
}

} // namespace firetwin::lod
