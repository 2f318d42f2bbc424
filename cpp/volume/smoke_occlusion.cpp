#include "volume/smoke_occlusion.hpp"

#include "base/check.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

namespace firetwin::volume {
namespace {

using Index = std::int64_t;

/// Largest ratio of a depth to the threshold: rays end there, and larger depths are clamped, so
/// that interpolation does not hide smoke next to a gap.
constexpr double max_ratio = 1.1;

/// A line of sight from a point in smoke.
struct LineOfSight {
  Vector from, direction;
  double length; ///< m

  Vector at(double distance) const {
    return {from[0] + distance * direction[0], from[1] + distance * direction[1],
            from[2] + distance * direction[2]};
  }
};

/// Returns the optical depth of a grid along a line; stops at `enough`.
double depth_along(const LineOfSight& line, const VoxelGrid& smoke, double enough) {
  double enter = 0.0, leave = line.length;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = smoke.origin[axis] - 0.5 * smoke.voxel - line.from[axis];
    const double high = low + static_cast<double>(smoke.shape[axis]) * smoke.voxel;
    if (line.direction[axis] == 0.0) {
      leave = low <= 0.0 && high >= 0.0 ? leave : 0.0;
      continue;
    }
    const double one = low / line.direction[axis], other = high / line.direction[axis];
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  }
  if (leave <= enter) {
    return 0.0;
  }
  const double steps = std::ceil((leave - enter) / smoke.voxel), step = (leave - enter) / steps;
  double depth = 0.0;
  for (double k = 0.5; k < steps && depth <= enough; k += 1.0) {
    depth += step * static_cast<double>(sample(smoke, line.at(enter + k * step)));
  }
  return depth;
}

Vector row(std::span<const double> rows, std::size_t number) {
  return {rows[3 * number], rows[3 * number + 1], rows[3 * number + 2]};
}

/// Returns the smallest optical depth between a place and an eye, at most `enough`.
double least_depth(const Vector& place, const Viewpoints& eyes, const VoxelGrid& smoke,
                   const VoxelGrid* beyond, double enough) {
  double least = enough;
  const auto look = [&](const LineOfSight& line) {
    double depth = depth_along(line, smoke, least);
    if (beyond != nullptr && depth < least) {
      depth += depth_along(line, *beyond, least - depth);
    }
    least = std::min(least, depth);
  };
  for (std::size_t n = 0; n < eyes.places.size() / 3; ++n) {
    Vector direction = minus(row(eyes.places, n), place);
    const double length = std::sqrt(dot(direction, direction));
    for (double& part : direction) {
      part = length > 0.0 ? part / length : 0.0;
    }
    look({place, direction, length});
  }
  for (std::size_t n = 0; n < eyes.directions.size() / 3; ++n) {
    look({place, row(eyes.directions, n), std::numeric_limits<double>::infinity()});
  }
  return least;
}

void check(const Viewpoints& eyes) {
  check_finite(eyes.places, "places");
  check_finite(eyes.directions, "directions");
  for (std::size_t n = 0; n < eyes.directions.size() / 3; ++n) {
    const Vector direction = row(eyes.directions, n);
    if (std::abs(std::sqrt(dot(direction, direction)) - 1.0) > 1.0e-6) {
      throw std::invalid_argument("directions must be unit vectors");
    }
  }
}

/// Calls f(number, centre) for each voxel for which `wanted(number)` is true, on many threads.
template <class Predicate, class Function>
void each_voxel(const VoxelGrid& brick, const Predicate& wanted, const Function& f) {
  const auto [nx, ny, nz] = brick.shape;
  tbb::parallel_for(Index{0}, nx * ny, [&, ny, nz](Index row) {
    for (Index k = 0; k < nz; ++k) {
      const auto n = static_cast<std::size_t>(row * nz + k);
      if (wanted(n)) {
        f(n, Vector{brick.origin[0] + brick.voxel * static_cast<double>(row / ny),
                    brick.origin[1] + brick.voxel * static_cast<double>(row % ny),
                    brick.origin[2] + brick.voxel * static_cast<double>(k)});
      }
    }
  });
}

} // namespace

OwnedVoxelGrid occluded_smoke(const VoxelGrid& extinction, const Viewpoints& eyes, double depth,
                              const VoxelGrid* beyond, std::span<float> out) {
  check(extinction);
  check(eyes);
  check_above_zero(depth, "depth");
  if (out.size() != extinction.values.size()) {
    throw std::invalid_argument("the output must have the shape of extinction");
  }
  OwnedVoxelGrid smoke = halved(halved(extinction).view());
  if (eyes.places.empty() && eyes.directions.empty()) {
    return smoke;
  }
  const VoxelGrid occluders = smoke.view();
  const auto near = near_smoke(occluders);
  OwnedVoxelGrid depths{std::vector<float>(near.size()), smoke.shape, smoke.voxel, smoke.origin};
  each_voxel(
      occluders, [&](std::size_t n) { return near[n] != 0; },
      [&](std::size_t n, const Vector& place) {
        depths.values[n] =
            static_cast<float>(least_depth(place, eyes, occluders, beyond, max_ratio * depth));
      });
  const VoxelGrid between = depths.view();
  each_voxel(
      extinction, [&](std::size_t n) { return extinction.values[n] > 0.0F; },
      [&](std::size_t n, const Vector& place) {
        if (static_cast<double>(sample(between, place)) > depth) {
          out[n] = 1.0F;
        }
      });
  return smoke;
}

} // namespace firetwin::volume
