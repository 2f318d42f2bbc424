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

constexpr double endless = std::numeric_limits<double>::infinity();

/// Narrows the part of a line that lies between two planes across an axis.
void clip(double low, double high, double pace, double& enter, double& leave) {
  if (pace == 0.0) {
    leave = low <= 0.0 && high >= 0.0 ? leave : -endless;
    return;
  }
  enter = std::max(enter, std::min(low / pace, high / pace));
  leave = std::min(leave, std::max(low / pace, high / pace));
}

/// From block to block along a ray.
class Walk {
public:
  Walk(const Bricks& bricks, const Crossing& crossing, float enter) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float pace = crossing.pace[axis];
      const float at = crossing.place[axis] + pace * enter;
      const Index last = bricks.blocks()[axis] - 1;
      block_[axis] = std::clamp(static_cast<Index>(at) / Bricks::side, Index{0}, last);
      step_[axis] = pace < 0.0F ? -1 : 1;
      const Index face = (block_[axis] + (pace < 0.0F ? 0 : 1)) * Bricks::side;
      const bool moves = std::abs(pace) > 1.0e-12F;
      next_[axis] = moves ? (static_cast<float>(face) - crossing.place[axis]) / pace : never;
      more_[axis] = moves ? static_cast<float>(Bricks::side) / std::abs(pace) : never;
    }
  }

  const std::array<Index, 3>& block() const { return block_; }
  float leaves() const { return next_[axis()]; }
  /// Goes on to the next block; false outside of all.
  bool go_on(const std::array<Index, 3>& blocks) {
    const std::size_t a = axis();
    block_[a] += step_[a];
    next_[a] += more_[a];
    return block_[a] >= 0 && block_[a] < blocks[a];
  }

private:
  static constexpr float never = std::numeric_limits<float>::max();

  std::size_t axis() const {
    const std::size_t flat = next_[0] < next_[1] ? 0 : 1;
    return next_[flat] < next_[2] ? flat : 2;
  }

  std::array<Index, 3> block_, step_;
  std::array<float, 3> next_, more_;
};

void find_segments(const Bricks& bricks, Crossing& crossing, float end) {
  double enter = 0.0, leave = static_cast<double>(end);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double place = static_cast<double>(crossing.place[axis]);
    const double high = static_cast<double>(bricks.shape()[axis] - 1);
    clip(-place, high - place, static_cast<double>(crossing.pace[axis]), enter, leave);
  }
  crossing.segments.clear();
  crossing.at = 0;
  if (enter >= leave) {
    return;
  }
  const float last = static_cast<float>(leave);
  float from = static_cast<float>(enter);
  Walk walk(bricks, crossing, from);
  do {
    const float to = std::min(walk.leaves(), last);
    const auto [i, j, k] = walk.block();
    const std::uint16_t* voxels = bricks.block(i, j, k);
    if (voxels != nullptr && to > from) {
      const auto corner = [](Index block) { return static_cast<float>(block * Bricks::side); };
      crossing.segments.push_back({from, to, voxels, {corner(i), corner(j), corner(k)}});
    }
    from = std::max(from, to);
  } while (from < last && walk.go_on(bricks.blocks()));
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
    throw std::invalid_argument("rays need one origin, or one for each direction");
  }
  if (distances.size() != rays.size() * taps) {
    throw std::invalid_argument("each ray needs its distances");
  }
}

const Segment* Crossing::reach(float distance) {
  constexpr float near = 1.0e-3F; // m; ends that are rounded apart count as one
  while (at < segments.size() && segments[at].to <= distance + near) {
    ++at;
  }
  return at < segments.size() ? &segments[at] : nullptr;
}

RayTraversal::RayTraversal(Layers layers)
    : layers_(layers),
      box_{Vector{endless, endless, endless}, Vector{-endless, -endless, -endless}},
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
  entry_ = enter; // numbers of the march are small even from 36,000 km away
  bool any = false;
  for (std::size_t n = 0; n < layers_.size(); ++n) {
    Crossing& crossing = crossings_[n];
    const double voxel = layers_[n]->voxel();
    crossing.voxel = static_cast<float>(voxel);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = origin[axis] + direction[axis] * enter - layers_[n]->origin()[axis];
      crossing.place[axis] = static_cast<float>(place / voxel);
      crossing.pace[axis] = static_cast<float>(direction[axis] / voxel);
    }
    find_segments(*layers_[n], crossing, static_cast<float>(leave - enter));
    any = any || !crossing.segments.empty();
  }
  return any;
}

float density(const std::uint16_t* voxels, const std::array<float, 3>& place) {
  constexpr std::size_t z = Bricks::channels, y = Bricks::wide * z, x = Bricks::wide * y;
  std::array<std::size_t, 3> low;
  std::array<float, 3> part;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float held = std::clamp(place[axis], 0.0F, static_cast<float>(Bricks::side));
    low[axis] =
        std::min(static_cast<std::size_t>(held), static_cast<std::size_t>(Bricks::side - 1));
    part[axis] = held - static_cast<float>(low[axis]);
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
