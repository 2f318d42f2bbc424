#include "tiles/screen_error.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firetwin::tiles {
namespace {

constexpr double min_distance = 1.0e-7; // m
constexpr std::size_t tiles_per_task = 64;

void check(std::span<const double> values, const char* what) {
  if (!std::all_of(values.begin(), values.end(), [](double v) { return v >= 0.0; })) {
    throw std::invalid_argument(what);
  }
}

/// Largest pixel scales of the branches of a view set, per projection; 0 for the other projection.
struct Scales {
  std::vector<double> perspective, orthographic;

  Scales(const lod::ViewSet& view_set, std::span<const double> pixels) {
    std::vector<double> near(pixels.begin(), pixels.end()), flat(pixels.begin(), pixels.end());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      (view_set.view(i).orthographic ? near : flat)[i] = 0.0;
    }
    perspective = view_set.largest_of_branches(near);
    orthographic = view_set.largest_of_branches(flat);
  }
};

} // namespace

double Volumes::distance(std::size_t i, const Vector& place) const {
  const Vector to = minus(place, {centre[3 * i], centre[3 * i + 1], centre[3 * i + 2]});
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double* along = &axis[9 * i + 3 * k];
    const double beyond = std::abs(dot(to, {along[0], along[1], along[2]})) - half[3 * i + k];
    if (beyond > 0.0) {
      sum += beyond * beyond;
    }
  }
  return std::max(std::sqrt(sum) - padding[i], 0.0);
}

lod::BoundingSphere Volumes::sphere(std::size_t i) const {
  const Vector extent{half[3 * i], half[3 * i + 1], half[3 * i + 2]};
  return {{centre[3 * i], centre[3 * i + 1], centre[3 * i + 2]},
          std::sqrt(dot(extent, extent)) + padding[i]};
}

void screen_error(const Volumes& volumes, std::span<const double> error,
                  const lod::ViewSet& view_set, std::span<const double> pixels,
                  const lod::CullOptions& options, std::span<double> out) {
  if (pixels.size() != view_set.size()) {
    throw std::invalid_argument("pixels must have one number for each view");
  }
  check(pixels, "pixels must be 0 or more");
  check(error, "error must be 0 or more");
  check(volumes.half, "half must be 0 or more");
  check(volumes.padding, "padding must be 0 or more");
  if (!(options.margin >= 0.0) || !(options.max_distance >= 0.0)) {
    throw std::invalid_argument("margin and max_distance must be 0 or more");
  }
  const Scales scales(view_set, pixels);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, out.size(), tiles_per_task), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const auto bound = [&](std::size_t branch, const Vector& camera, double moved) {
            const double away = std::max(volumes.distance(i, camera) - moved, min_distance);
            return std::max(error[i] * scales.perspective[branch] / away,
                            error[i] * scales.orthographic[branch]);
          };
          out[i] = view_set.largest(volumes.sphere(i), options, bound);
        }
      });
}

void contains_any(const Volumes& volumes, std::span<const double> place, std::span<bool> out) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, out.size()), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      out[i] = false;
      for (std::size_t k = 0; k + 2 < place.size() && !out[i]; k += 3) {
        out[i] = volumes.distance(i, {place[k], place[k + 1], place[k + 2]}) == 0.0;
      }
    }
  });
}

} // namespace firetwin::tiles
