#include "lod/visible.hpp"

#include "lod/occlusion.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace firetwin::lod {
namespace {

void check(std::span<const double> radius, std::span<const View> path, const ViewLimits& limits) {
  const auto bad_angle = [](double a) { return a <= 0.0 || a >= std::numbers::pi; };
  for (const View& view : path) {
    if (bad_angle(view.width) || bad_angle(view.height)) {
      throw std::invalid_argument("fov must be angles between 0 and pi radians");
    }
  }
  if (std::any_of(radius.begin(), radius.end(), [](double r) { return r < 0.0; }) ||
      !(limits.margin >= 0.0)) {
    throw std::invalid_argument("radius and margin must be 0 or more");
  }
  if (std::isnan(limits.near) || std::isnan(limits.far)) {
    throw std::invalid_argument("near and far must be distances, not NaN");
  }
}

class Path {
public:
  Path(std::span<const View> views, const ViewLimits& limits) : views_(views), limits_(limits) {
    for (const View& view : views) {
      frusta_.emplace_back(view, limits.near, limits.far);
    }
  }

  std::int32_t size() const { return static_cast<std::int32_t>(views_.size()); }

  bool sees(std::int32_t view, const Vector& centre, double radius) const {
    const auto v = static_cast<std::size_t>(view);
    const double wide = radius + limits_.margin;
    return frusta_[v].touches(centre, wide) &&
           !(limits_.ground && hidden(views_[v].position, centre, wide, *limits_.ground));
  }

private:
  std::span<const View> views_;
  std::vector<Frustum> frusta_;
  ViewLimits limits_;
};

} // namespace

std::vector<std::int32_t> seen(std::span<const double> centre, std::span<const double> radius,
                               std::span<const View> path, const ViewLimits& limits) {
  check(radius, path, limits);
  const Path all(path, limits);
  std::vector<std::int32_t> result(2 * radius.size(), -1);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, radius.size(), 16), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const Vector place = {centre[3 * i], centre[3 * i + 1], centre[3 * i + 2]};
      std::int32_t first = 0, last = all.size() - 1;
      while (first < all.size() && !all.sees(first, place, radius[i])) {
        ++first;
      }
      if (first == all.size()) {
        continue;
      }
      while (last > first && !all.sees(last, place, radius[i])) {
        --last;
      }
      result[2 * i] = first;
      result[2 * i + 1] = last;
    }
  });
  return result;
}

} // namespace firetwin::lod
