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

/// Origins and directions of rays.
struct Rays {
  std::span<const double> origins;    ///< (n, 3) m, or (3) if all rays start at one point
  std::span<const double> directions; ///< (n, 3) unit vectors

  std::size_t size() const { return directions.size() / 3; }
  Vector origin(std::size_t ray) const;
  Vector direction(std::size_t ray) const;
};

/// @throws std::invalid_argument unless there is one origin, or one per ray, and `taps` distances
/// per ray
void check(const Rays& rays, std::span<const float> distances, std::size_t taps);

/// Part of a ray inside one block with smoke.
struct Segment {
  float from, to; ///< m from the ray's entry into the layers' bounding box
  const std::uint16_t* voxels;
  std::array<float, 3> corner; ///< index of the block's first voxel
};

/// Intersection of a ray with a layer.
struct LayerCrossing {
  /// Ray in the layer's index space: voxels, and voxels per m.
  std::array<float, 3> index_origin, index_direction;
  float voxel = 0.0F; ///< m
  const NoiseFrame* noise = nullptr;
  std::vector<Segment> segments; ///< near to far
  std::size_t current = 0;       ///< index of the segment being marched

  /// Moves to the first segment that ends beyond `distance`.
  const Segment* advance_to(float distance);
};

/// Ray traversal of the blocks of all layers by a 3-D digital differential analyser, DDA (J.
/// Amanatides and A. Woo 1987). Use one object per thread: it reuses its memory.
class RayTraversal {
public:
  explicit RayTraversal(Layers layers);

  /// Traces a ray up to `end` (m). Returns false if it meets no smoke.
  bool follow(const Vector& origin, const Vector& direction, double end);

  /// Distance from the origin to the point where segments count from, m.
  double entry() const { return entry_; }
  std::vector<LayerCrossing>& crossings() { return crossings_; }
  /// Layer whose next segment is nearest; null if no segment is left.
  LayerCrossing* nearest();

private:
  Layers layers_;
  std::array<Vector, 2> box_; ///< bounding box of all layers
  double entry_ = 0.0;
  std::vector<LayerCrossing> crossings_;
};

/// Returns the position of a point of a ray in its block, voxels.
inline std::array<float, 3> local(const LayerCrossing& crossing, const Segment& segment,
                                  float distance) {
  std::array<float, 3> found;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    found[axis] = crossing.index_origin[axis] + crossing.index_direction[axis] * distance -
                  segment.corner[axis];
  }
  return found;
}

/// Interpolates extinction linearly between voxels, 1/m.
float density(const std::uint16_t* voxels, const std::array<float, 3>& position);

/// Calls f(state, ray) for rays 0 to count - 1 on all threads; `make()` makes the state of each
/// task.
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
