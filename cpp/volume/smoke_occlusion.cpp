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

constexpr double most = 1.1; // times the depth asked for: ways end there, and what is deeper counts
                             // as that deep, so that smoke beside a gap is not hidden by more of it
constexpr double endless = std::numeric_limits<double>::infinity();

/// A line of sight from a place in smoke.
struct RayTraversal {
  Vector from, direction;
  double length; ///< m

  Vector at(double distance) const {
    return {from[0] + distance * direction[0], from[1] + distance * direction[1],
            from[2] + distance * direction[2]};
  }
};

/// Optical depth of a brick along a way, or of so much of it as is `enough`.
double depth_along(const RayTraversal& way, const VoxelGrid& smoke, double enough) {
  double enter = 0.0, leave = way.length;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = smoke.origin[axis] - 0.5 * smoke.voxel - way.from[axis];
    const double high = low + static_cast<double>(smoke.shape[axis]) * smoke.voxel;
    if (way.direction[axis] == 0.0) {
      leave = low <= 0.0 && high >= 0.0 ? leave : 0.0;
      continue;
    }
    const double one = low / way.direction[axis], other = high / way.direction[axis];
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  }
  if (leave <= enter) {
    return 0.0;
  }
  const double steps = std::ceil((leave - enter) / smoke.voxel), step = (leave - enter) / steps;
  double depth = 0.0;
  for (double k = 0.5; k < steps && depth <= enough; k += 1.0) {
    depth += step * static_cast<double>(sample(smoke, way.at(enter + k * step)));
  }
  return depth;
}

Vector row(std::span<const double> rows, std::size_t number) {
  return {rows[3 * number], rows[3 * number + 1], rows[3 * number + 2]};
}

/// Least optical depth between a place and an eye, or `enough` where that is less.
double least_depth(const Vector& place, const Viewpoints& eyes, const VoxelGrid& smoke,
                   const VoxelGrid* beyond, double enough) {
  double least = enough;
  const auto look = [&](const RayTraversal& way) {
    double depth = depth_along(way, smoke, least);
    if (beyond != nullptr && depth < least) {
      depth += depth_along(way, *beyond, least - depth);
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
    look({place, row(eyes.directions, n), endless});
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

/// f(number, middle) for every voxel for which `wanted(number)`, on many threads.
template <class GridRequest, class Function>
void each_voxel(const VoxelGrid& brick, const GridRequest& wanted, const Function& f) {
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
    throw std::invalid_argument("arrays of smoke and what is hidden must have the same shape");
  }
  OwnedVoxelGrid smoke = halved(halved(extinction).view());
  if (eyes.places.empty() && eyes.directions.empty()) {
    return smoke;
  }
  const VoxelGrid hides = smoke.view();
  const auto near = near_smoke(hides);
  OwnedVoxelGrid depths{std::vector<float>(near.size()), smoke.shape, smoke.voxel, smoke.origin};
  each_voxel(
      hides, [&](std::size_t n) { return near[n] != 0; },
      [&](std::size_t n, const Vector& place) {
        depths.values[n] =
            static_cast<float>(least_depth(place, eyes, hides, beyond, most * depth));
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
