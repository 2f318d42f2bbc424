#pragma once

#include "base/vector.hpp"
#include "volume/bricks.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::volume {

using Layers = std::span<const Bricks* const>;

/// Rays to be followed, as many as there are directions.
struct Rays {
  std::span<const double> origins;    ///< (n, 3) m, or (3) where all begin in one place
  std::span<const double> directions; ///< (n, 3) unit vectors

  std::size_t size() const { return directions.size() / 3; }
  Vector origin(std::size_t ray) const;
  Vector direction(std::size_t ray) const;
};

/// @throws std::invalid_argument unless each ray has `taps` distances, and an origin or that of all
void check(const Rays& rays, std::span<const float> distances, std::size_t taps);

/// Part of a ray that lies in one block with smoke.
struct Segment {
  float from, to; ///< m from where the ray enters all of the smoke
  const std::uint16_t* voxels;
  std::array<float, 3> corner; ///< the block's first voxel
};

/// A layer as one ray goes through it.
struct Crossing {
  std::array<float, 3> place, pace; ///< voxels, and voxels per m
  float voxel = 0.0F;               ///< m
  std::vector<Segment> segments;    ///< from the near to the far
  std::size_t at = 0;               ///< the segment that is being marched

  /// Goes on to the first segment that ends behind `distance`.
  const Segment* reach(float distance);
};

/// Ray traversal of the blocks of all layers by a 3-D digital differential analyser
/// (J. Amanatides and A. Woo 1987). Use one object per thread: it reuses its memory.
class RayTraversal {
public:
  explicit RayTraversal(Layers layers);

  /// Follows a ray to `end` (m). False where it meets no smoke.
  bool follow(const Vector& origin, const Vector& direction, double end);

  double entry() const { return entry_; } ///< m from the origin to where segments count from
  std::vector<Crossing>& crossings() { return crossings_; }

private:
  Layers layers_;
  std::array<Vector, 2> box_; ///< round all layers
  double entry_ = 0.0;
  std::vector<Crossing> crossings_;
};

/// Where in its block a point of a ray lies, voxels.
inline std::array<float, 3> local(const Crossing& crossing, const Segment& segment,
                                  float distance) {
  std::array<float, 3> found;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    found[axis] = crossing.place[axis] + crossing.pace[axis] * distance - segment.corner[axis];
  }
  return found;
}

/// Extinction there, linear between voxels, 1/m.
float density(const std::uint16_t* voxels, const std::array<float, 3>& place);

/// f(follower, ray) for rays 0 to count - 1 on all threads; `make()` gives what follows them.
template <class Make, class Function>
void for_rays(std::size_t count, const Make& make, const Function& function) {
  constexpr std::size_t together = 64;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, together), [&](const auto& range) {
    auto follower = make();
    for (std::size_t ray = range.begin(); ray < range.end(); ++ray) {
      function(follower, ray);
    }
  });
}

} // namespace firetwin::volume
