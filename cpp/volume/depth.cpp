#include "volume/depth.hpp"

#include "base/clones.hpp"
#include "volume/lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

namespace firetwin::volume {
namespace {

constexpr float nowhere = -std::numeric_limits<float>::infinity();

struct View {
  const float* x;
  const float* y;
  const float* z;
  const float* radius;
  std::size_t count; // padded to full lanes
};

/// Computes the depths of one point in all balls; returns the largest.
FIRETWIN_CLONES("avx2")
float depths_at(const View& balls, const float* point, float* depths) {
  Lanes most = Lanes{} + nowhere;
  for (std::size_t i = 0; i < balls.count; i += lane_count) {
    Lanes x;
    Lanes y;
    Lanes z;
    Lanes radius;
    std::memcpy(&x, balls.x + i, sizeof x);
    std::memcpy(&y, balls.y + i, sizeof y);
    std::memcpy(&z, balls.z + i, sizeof z);
    std::memcpy(&radius, balls.radius + i, sizeof radius);
    x -= point[0];
    y -= point[1];
    z -= point[2];
    Lanes depth = x * x + y * y + z * z;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      depth[lane] = std::sqrt(depth[lane]);
    }
    depth = radius - depth;
    std::memcpy(depths + i, &depth, sizeof depth);
    most = depth > most ? depth : most;
  }
  float largest = nowhere;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    largest = std::max(largest, most[lane]);
  }
  return largest;
}

/// Finds the depths of eight points in their deepest balls, and the radii of these balls.
FIRETWIN_CLONES("avx2")
void deepest(const View& balls, const float* points, float* depths, float* radii) {
  Lanes px;
  Lanes py;
  Lanes pz;
  std::memcpy(&px, points, sizeof px);
  std::memcpy(&py, points + lane_count, sizeof py);
  std::memcpy(&pz, points + 2 * lane_count, sizeof pz);
  Lanes most = Lanes{} - depth_outside;
  Lanes chosen{};
  for (std::size_t i = 0; i < balls.count; ++i) {
    const Lanes x = px - balls.x[i];
    const Lanes y = py - balls.y[i];
    const Lanes z = pz - balls.z[i];
    Lanes depth = x * x + y * y + z * z;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      depth[lane] = std::sqrt(depth[lane]);
    }
    const Lanes radius = Lanes{} + balls.radius[i];
    depth = radius - depth;
    const auto deeper = depth > most;
    chosen = deeper ? radius : chosen;
    most = deeper ? depth : most;
  }
  std::memcpy(depths, &most, sizeof most);
  std::memcpy(radii, &chosen, sizeof chosen);
}

std::size_t voxel_at(std::size_t x, std::size_t y, std::size_t z) {
  return (x * leaf_side + y) * leaf_side + z;
}

/// Returns the mask of the blocks of 2^3 voxels in a larger block.
std::uint64_t small_blocks(const std::array<std::size_t, 3>& origin, std::size_t side) {
  const std::size_t count = side / 2;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < count * count * count; ++i) {
    const std::size_t x = origin[0] / 2 + i / (count * count);
    const std::size_t y = origin[1] / 2 + i / count % count;
    const std::size_t z = origin[2] / 2 + i % count;
    bits |= std::uint64_t{1} << ((x * 4 + y) * 4 + z);
  }
  return bits;
}

} // namespace

void DepthMeter::Balls::reserve(std::size_t most) {
  if (x.size() < most + lane_count) {
    for (std::vector<float>* column : {&x, &y, &z, &radius}) {
      column->resize(most + lane_count);
    }
  }
  count = 0;
}

void DepthMeter::Balls::add(float ball_x, float ball_y, float ball_z, float ball_radius) {
  x[count] = ball_x;
  y[count] = ball_y;
  z[count] = ball_z;
  radius[count] = ball_radius;
  ++count;
}

void DepthMeter::Balls::select(const Balls& from, std::span<const float> depths, float least) {
  count = 0;
  for (std::size_t i = 0; i < from.count; ++i) { // branch-free: the branch would be unpredictable
    x[count] = from.x[i];
    y[count] = from.y[i];
    z[count] = from.z[i];
    radius[count] = from.radius[i];
    count += depths[i] >= least ? 1 : 0;
  }
  fill_up();
}

void DepthMeter::Balls::fill_up() {
  for (std::size_t i = count; i < count + lane_count; ++i) {
    x[i] = y[i] = z[i] = 0.0F;
    radius[i] = nowhere;
  }
}

void DepthMeter::measure(const Puffs& puffs, std::span<const std::uint32_t> balls,
                         const std::array<float, 3>& corner, float voxel_size, std::uint64_t wanted,
                         LeafValues& depth, LeafValues& radius) {
  corner_ = corner;
  voxel_ = voxel_size;
  depth_ = &depth;
  radius_ = &radius;
  depth.fill(-depth_outside);
  radius.fill(0.0F);
  for (Balls& round : balls_) {
    round.reserve(balls.size());
  }
  if (depths_.size() < balls.size() + lane_count) {
    depths_.resize(balls.size() + lane_count);
  }
  for (const std::uint32_t ball : balls) {
    const float* centre = &puffs.position[3 * ball];
    balls_[0].add(centre[0], centre[1], centre[2], puffs.radius[ball]);
  }
  balls_[0].fill_up();
  refine({{0, 0, 0}, leaf_side, 0}, wanted);
}

std::array<float, 3> DepthMeter::point(const Block& block, float offset) const {
  std::array<float, 3> point{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point[axis] = corner_[axis] + (static_cast<float>(block.origin[axis]) + offset) * voxel_;
  }
  return point;
}

void DepthMeter::refine(const Block& block, std::uint64_t wanted) {
  const Balls& from = balls_[block.round];
  Balls& left = balls_[block.round + 1];
  const float middle = 0.5F * static_cast<float>(block.side - 1);
  // Distance from the centre to the outermost voxels, with a margin for rounding.
  const float half = middle * voxel_ * std::numbers::sqrt3_v<float> * 1.0001F + 0.1F;
  const std::size_t lanes = (from.count + lane_count - 1) / lane_count * lane_count;
  const View view{from.x.data(), from.y.data(), from.z.data(), from.radius.data(), lanes};
  const float most = depths_at(view, point(block, middle).data(), depths_.data());
  if (most < -depth_outside - half) {
    return;
  }
  if (most - half >= depth_inside) {
    const auto end = depths_.begin() + static_cast<std::ptrdiff_t>(from.count);
    const auto ball = std::find(depths_.begin(), end, most) - depths_.begin();
    fill(block, most - half, from.radius[static_cast<std::size_t>(ball)]);
    return;
  }
  const float limit = std::max(most - 2.0F * half, -depth_outside - half);
  left.select(from, depths_, limit);
  if (block.side == 2) {
    measure_voxels(block, left);
    return;
  }
  const std::size_t side = block.side / 2;
  for (std::size_t part = 0; part < 8; ++part) {
    Block next{block.origin, side, block.round + 1};
    next.origin[0] += (part >> 2 & 1) * side;
    next.origin[1] += (part >> 1 & 1) * side;
    next.origin[2] += (part & 1) * side;
    if ((wanted & small_blocks(next.origin, side)) != 0) {
      refine(next, wanted);
    }
  }
}

void DepthMeter::fill(const Block& block, float depth, float radius) {
  for (std::size_t x = 0; x < block.side; ++x) {
    for (std::size_t y = 0; y < block.side; ++y) {
      const auto row = static_cast<std::ptrdiff_t>(
          voxel_at(block.origin[0] + x, block.origin[1] + y, block.origin[2]));
      std::fill_n(depth_->begin() + row, block.side, depth);
      std::fill_n(radius_->begin() + row, block.side, radius);
    }
  }
}

void DepthMeter::measure_voxels(const Block& block, const Balls& balls) {
  std::array<float, 3 * lane_count> points{};
  std::array<std::size_t, lane_count> voxels{};
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const std::array<std::size_t, 3> at{block.origin[0] + (lane >> 2 & 1),
                                        block.origin[1] + (lane >> 1 & 1),
                                        block.origin[2] + (lane & 1)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      points[axis * lane_count + lane] = corner_[axis] + static_cast<float>(at[axis]) * voxel_;
    }
    voxels[lane] = voxel_at(at[0], at[1], at[2]);
  }
  std::array<float, lane_count> depths{};
  std::array<float, lane_count> radii{};
  deepest({balls.x.data(), balls.y.data(), balls.z.data(), balls.radius.data(), balls.count},
          points.data(), depths.data(), radii.data());
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    (*depth_)[voxels[lane]] = depths[lane];
    (*radius_)[voxels[lane]] = radii[lane];
  }
}

} // namespace firetwin::volume
