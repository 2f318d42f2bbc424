#include "lod/view_set.hpp"

#include "base/check.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace firetwin::lod {
namespace {

constexpr double lowest_sun = 0.0175; // sine of one degree
constexpr double thinnest_step = 1.0; // m
/// Growth of the steps along a shadow, as a fraction of the distance from the sphere.
constexpr double step_growth = 0.125;

double length(const Vector& v) {
  return std::sqrt(dot(v, v));
}

bool has_sun(const View& view) {
  return view.sun[2] >= lowest_sun;
}

/// Largest change of a unit vector by the rotation between two views (spectral norm of the
/// difference).
double turn(const View& a, const View& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 9; ++i) {
    sum += (a.to_world[i] - b.to_world[i]) * (a.to_world[i] - b.to_world[i]);
  }
  return std::sqrt(0.5 * sum);
}

void check(const View& view) {
  check_finite(view.position, "camera");
  check_finite(view.to_world, "rotation");
  check_finite(view.sun, "sun");
  check_above_zero(view.half_width, "half_extent");
  check_above_zero(view.half_height, "half_extent");
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double product = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        product += view.to_world[3 * i + k] * view.to_world[3 * j + k];
      }
      if (std::abs(product - (i == j ? 1.0 : 0.0)) > 1.0e-6) {
        throw std::invalid_argument("rotation must be orthonormal");
      }
    }
  }
  if (const double s = dot(view.sun, view.sun); s > 1.0e-12 && std::abs(s - 1.0) > 1.0e-6) {
    throw std::invalid_argument("sun must be a unit vector, or 0 without shadows");
  }
}

} // namespace

ViewSet::ViewSet(std::vector<View> views, std::shared_ptr<const Occluder> occluder,
                 double lowest_terrain)
    : views_(std::move(views)), occluder_(std::move(occluder)), lowest_terrain_(lowest_terrain) {
  check_finite(lowest_terrain, "lowest_terrain");
  std::for_each(views_.begin(), views_.end(), check);
  if (!views_.empty()) {
    branches_.reserve(2 * views_.size());
    grow(0, views_.size());
  }
}

std::size_t ViewSet::grow(std::size_t first, std::size_t last) {
  const std::size_t here = branches_.size();
  branches_.push_back(branch(first, last));
  const auto as_wide = [&](const View& view) {
    return view.half_width == views_[first].half_width &&
           view.half_height == views_[first].half_height;
  };
  const auto begin = views_.begin();
  const bool one = branches_[here].moved == 0.0 && branches_[here].turned == 0.0 &&
                   branches_[here].sun_moved == 0.0 &&
                   branches_[here].perspective != branches_[here].orthographic &&
                   std::all_of(begin + static_cast<std::ptrdiff_t>(first),
                               begin + static_cast<std::ptrdiff_t>(last), as_wide);
  if (last - first > 1 && !one) {
    const std::size_t half = first + (last - first) / 2;
    const std::size_t left = grow(first, half);
    const std::size_t right = grow(half, last);
    branches_[here].left = left;
    branches_[here].right = right;
  }
  return here;
}

ViewSet::Branch ViewSet::branch(std::size_t first, std::size_t last) const {
  const std::size_t middle = first + (last - first) / 2;
  View widest = views_[middle];
  Branch b{first, last, 0, 0, middle, Frustum(widest), 0.0, 0.0, false, false, true, {}, 0.0, 0.0};
  for (std::size_t i = first; i < last; ++i) {
    const View& view = views_[i];
    widest.half_width = std::max(widest.half_width, view.half_width);
    widest.half_height = std::max(widest.half_height, view.half_height);
    b.moved = std::max(b.moved, length(minus(view.position, widest.position)));
    b.turned = std::max(b.turned, turn(view, widest));
    b.perspective = b.perspective || !view.orthographic;
    b.orthographic = b.orthographic || view.orthographic;
    b.above_terrain = b.above_terrain && view.above_terrain && !view.orthographic;
    if (has_sun(view)) {
      b.sun = b.sun_height > 0.0 ? b.sun : view.sun;
      b.sun_height = b.sun_height > 0.0 ? std::min(b.sun_height, view.sun[2]) : view.sun[2];
      b.sun_moved = std::max(b.sun_moved, length(minus(view.sun, b.sun)));
    }
  }
  b.frustum = Frustum(widest);
  return b;
}

double ViewSet::shift(const Branch& b, const Vector& place) const {
  return b.moved + b.turned * length(minus(place, views_[b.middle].position));
}

bool ViewSet::may_be_in_view(const Branch& b, const BoundingSphere& sphere,
                             const CullOptions& options, const Occluder* occluder,
                             double& ridge) const {
  if (b.perspective && b.orthographic) {
    return true;
  }
  const BoundingSphere camera{views_[b.middle].position, b.moved};
  const double nearest = length(minus(sphere.centre, camera.centre)) - sphere.radius - b.moved;
  if (b.perspective && !(nearest <= options.max_distance)) {
    return false;
  }
  const double radius = sphere.radius + options.margin + shift(b, sphere.centre);
  return b.frustum.intersects(sphere.centre, radius) &&
         !(occluder && b.above_terrain && occluder->occludes(camera, sphere, ridge));
}

BoundingSphere ViewSet::shadow_sphere(const Branch& b, const BoundingSphere& sphere, double from,
                                      double to) {
  const double at = 0.5 * (from + to);
  return {{sphere.centre[0] - at * b.sun[0], sphere.centre[1] - at * b.sun[1],
           sphere.centre[2] - at * b.sun[2]},
          std::sqrt(sphere.radius * sphere.radius + (to - at) * (to - at)) + to * b.sun_moved};
}

/// Follows the sun rays through the sphere until all of them are below the ground.
bool ViewSet::may_cast_shadow(const Branch& b, const BoundingSphere& sphere,
                              const CullOptions& options, const Occluder* occluder,
                              double& ridge) const {
  if (b.sun_height <= 0.0) {
    return false;
  }
  const double most =
      std::max(sphere.centre[2] + sphere.radius - lowest_terrain_, 0.0) / b.sun_height;
  const auto step = [&](double way) {
    return std::max({2.0 * sphere.radius, step_growth * way, thinnest_step});
  };
  double end = 0.0;
  while (end < most &&
         !(occluder && occluder->is_below(shadow_sphere(b, sphere, end, end + step(end))))) {
    end += step(end);
  }
  if (!may_be_in_view(b, shadow_sphere(b, sphere, 0.0, end), options, occluder, ridge)) {
    return false;
  }
  for (double way = 0.0; way < end; way += step(way)) {
    if (may_be_in_view(b, shadow_sphere(b, sphere, way, way + step(way)), options, occluder,
                       ridge)) {
      return true;
    }
  }
  return false;
}

bool ViewSet::may_be_visible(const Branch& b, const BoundingSphere& sphere,
                             const CullOptions& options, const Occluder* occluder,
                             double& ridge) const {
  return may_be_in_view(b, sphere, options, occluder, ridge) ||
         (options.shadows && may_cast_shadow(b, sphere, options, occluder, ridge));
}

bool ViewSet::is_visible(const BoundingSphere& sphere, const CullOptions& options) const {
  std::size_t last = 0;
  double ridge = 0.0;
  return !branches_.empty() && is_visible(0, sphere, options, last, ridge);
}

bool ViewSet::is_visible(std::size_t number, const BoundingSphere& sphere,
                         const CullOptions& options, std::size_t& leaf, double& ridge) const {
  const Branch& b = branches_[number];
  if (!may_be_visible(b, sphere, options, occluder_.get(), ridge)) {
    return false;
  }
  if (b.left == 0) {
    leaf = number;
    return true;
  }
  return is_visible(b.left, sphere, options, leaf, ridge) ||
         is_visible(b.right, sphere, options, leaf, ridge);
}

std::vector<double> ViewSet::largest_of_branches(std::span<const double> of_view) const {
  std::vector<double> most;
  most.reserve(branches_.size());
  for (const Branch& b : branches_) {
    most.push_back(*std::max_element(of_view.begin() + static_cast<std::ptrdiff_t>(b.first),
                                     of_view.begin() + static_cast<std::ptrdiff_t>(b.last)));
  }
  return most;
}

double ViewSet::distance(const Vector& place) const {
  double least = std::numeric_limits<double>::infinity();
  if (!branches_.empty()) {
    distance(0, place, least);
  }
  return least;
}

void ViewSet::distance(std::size_t number, const Vector& place, double& least) const {
  const Branch& b = branches_[number];
  const double away = length(minus(place, views_[b.middle].position));
  if (!b.perspective || away - b.moved >= least) {
    return;
  }
  if (b.left == 0) {
    least = away;
    return;
  }
  const auto from = [&](std::size_t child) {
    return length(minus(place, views_[branches_[child].middle].position));
  };
  const bool swap = from(b.right) < from(b.left);
  distance(swap ? b.right : b.left, place, least);
  distance(swap ? b.left : b.right, place, least);
}

} // namespace firetwin::lod
