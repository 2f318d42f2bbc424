#include "volume/ray.hpp"

#include "volume/half.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace firetwin::volume {
namespace {

using Index = std::int64_t;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Clips a line to the slab between two planes across an axis.
void clip(double low, double high, double direction, double& enter, double& leave) {
  if (direction == 0.0) {
    leave = low <= 0.0 && high >= 0.0 ? leave : -infinity;
    return;
  }
  enter = std::max(enter, std::min(low / direction, high / direction));
  leave = std::min(leave, std::max(low / direction, high / direction));
}

/// Steps from block to block along a ray.
class BlockTraversal {
public:
  BlockTraversal(const Bricks& bricks, const LayerCrossing& crossing, float enter) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float direction = crossing.index_direction[axis];
      const float at = crossing.index_origin[axis] + direction * enter;
      const Index last = bricks.blocks()[axis] - 1;
      block_[axis] = std::clamp(static_cast<Index>(at) / Bricks::side, Index{0}, last);
      step_[axis] = direction < 0.0F ? -1 : 1;
      const Index face = (block_[axis] + (direction < 0.0F ? 0 : 1)) * Bricks::side;
      const bool moves = std::abs(direction) > 1.0e-12F;
      next_face_[axis] =
          moves ? (static_cast<float>(face) - crossing.index_origin[axis]) / direction : never;
      face_spacing_[axis] = moves ? static_cast<float>(Bricks::side) / std::abs(direction) : never;
    }
  }

  const std::array<Index, 3>& block() const { return block_; }
  float exit() const { return next_face_[axis()]; }
  /// Moves to the next block; false if it is outside the grid.
  bool advance(const std::array<Index, 3>& blocks) {
    const std::size_t a = axis();
    block_[a] += step_[a];
    next_face_[a] += face_spacing_[a];
    return block_[a] >= 0 && block_[a] < blocks[a];
  }

private:
  static constexpr float never = std::numeric_limits<float>::max();

  std::size_t axis() const {
    const std::size_t flat = next_face_[0] < next_face_[1] ? 0 : 1;
    return next_face_[flat] < next_face_[2] ? flat : 2;
  }

  std::array<Index, 3> block_, step_;
  std::array<float, 3> next_face_, face_spacing_;
};

void find_segments(const Bricks& bricks, LayerCrossing& crossing, float end) {
  double enter = 0.0, leave = static_cast<double>(end);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double start = static_cast<double>(crossing.index_origin[axis]);
    const double high = static_cast<double>(bricks.shape()[axis] - 1);
    clip(-start, high - start, static_cast<double>(crossing.index_direction[axis]), enter, leave);
  }
  crossing.segments.clear();
  crossing.current = 0;
  if (enter >= leave) {
    return;
  }
  const float last = static_cast<float>(leave);
  float from = static_cast<float>(enter);
  BlockTraversal walk(bricks, crossing, from);
  do {
    const float to = std::min(walk.exit(), last);
    const auto [i, j, k] = walk.block();
    const std::uint16_t* voxels = bricks.block(i, j, k);
    if (voxels != nullptr && to > from) {
      const auto corner = [](Index block) { return static_cast<float>(block * Bricks::side); };
      crossing.segments.push_back({from, to, voxels, {corner(i), corner(j), corner(k)}});
    }
    from = std::max(from, to);
  } while (from < last && walk.advance(bricks.blocks()));
}

} // namespace

Vector Rays::origin(std::size_t ray) const {
  const std::size_t first = origins.size() == 3 ? 0 : 3 * ray;
  return {origins[first], origins[first + 1], origins[first + 2]};
}

Vector Rays::direction(std::size_t ray) const {
  return {directions[3 * ray], directions[3 * ray + 1], directions[3 * ray + 2]};
}

void check(const Rays& rays, std::span<const float> distances, std::size_t taps) {
  if (rays.origins.size() != 3 && rays.origins.size() != rays.directions.size()) {
    throw std::invalid_argument("origins must be (3,), or (n, 3) like directions");
  }
  if (distances.size() != rays.size() * taps) {
    throw std::invalid_argument("distances must have one row per direction");
  }
}

LayerCrossing* RayTraversal::nearest() {
  LayerCrossing* first = nullptr;
  for (LayerCrossing& each : crossings_) {
    const bool left = each.current < each.segments.size();
    if (left && (first == nullptr ||
                 each.segments[each.current].from < first->segments[first->current].from)) {
      first = &each;
    }
  }
  return first;
}

const Segment* LayerCrossing::advance_to(float distance) {
  constexpr float near = 1.0e-3F; // m; tolerance for rounded ends
  while (current < segments.size() && segments[current].to <= distance + near) {
    ++current;
  }
  return current < segments.size() ? &segments[current] : nullptr;
}

RayTraversal::RayTraversal(Layers layers)
    : layers_(layers),
      box_{Vector{infinity, infinity, infinity}, Vector{-infinity, -infinity, -infinity}},
      crossings_(layers.size()) {
  for (const Bricks* layer : layers) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double low = layer->origin()[axis];
      const double high = low + static_cast<double>(layer->shape()[axis] - 1) * layer->voxel();
      box_[0][axis] = std::min(box_[0][axis], low);
      box_[1][axis] = std::max(box_[1][axis], high);
    }
  }
}

bool RayTraversal::follow(const Vector& origin, const Vector& direction, double end) {
  double enter = 0.0, leave = end;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    clip(box_[0][axis] - origin[axis], box_[1][axis] - origin[axis], direction[axis], enter, leave);
  }
  if (!(enter < leave)) {
    return false;
  }
  entry_ = enter; // the march uses small numbers even if the eye is 36,000 km away
  bool any = false;
  for (std::size_t n = 0; n < layers_.size(); ++n) {
    LayerCrossing& crossing = crossings_[n];
    const double voxel = layers_[n]->voxel();
    crossing.voxel = static_cast<float>(voxel);
    crossing.noise = layers_[n]->noise();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double offset = origin[axis] + direction[axis] * enter - layers_[n]->origin()[axis];
      crossing.index_origin[axis] = static_cast<float>(offset / voxel);
      crossing.index_direction[axis] = static_cast<float>(direction[axis] / voxel);
    }
    find_segments(*layers_[n], crossing, static_cast<float>(leave - enter));
    any = any || !crossing.segments.empty();
  }
  return any;
}

float density(const std::uint16_t* voxels, const std::array<float, 3>& position) {
  constexpr std::size_t z = Bricks::channels, y = Bricks::wide * z, x = Bricks::wide * y;
  std::array<std::size_t, 3> low;
  std::array<float, 3> part;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float clamped = std::clamp(position[axis], 0.0F, static_cast<float>(Bricks::side));
    low[axis] =
        std::min(static_cast<std::size_t>(clamped), static_cast<std::size_t>(Bricks::side - 1));
    part[axis] = clamped - static_cast<float>(low[axis]);
  }
  const std::uint16_t* first = voxels + low[0] * x + low[1] * y + low[2] * z;
  const auto along_z = [&](const std::uint16_t* at) {
    const float a = from_half(at[0]), b = from_half(at[z]);
    return a + part[2] * (b - a);
  };
  const auto along_y = [&](const std::uint16_t* at) {
    const float a = along_z(at), b = along_z(at + y);
    return a + part[1] * (b - a);
  };
  const float a = along_y(first), b = along_y(first + x);
  return a + part[0] * (b - a);
}

} // namespace firetwin::volume
