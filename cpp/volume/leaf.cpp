#include "leaf.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace firetwin {
namespace {

constexpr float kGlowReach = 6000.0F; // m; exp(-6000 / 1100) is 0.4 %
constexpr double kGlowCore = 250.0;   // m
constexpr double kGlowPower = 1.0e9;  // W

struct Reach {
  float nearest; // m from a ball's centre to the leaf
  float farthest;
};

Reach reach(const std::array<float, 3>& corner, float side, const float* centre) {
  float near2 = 0.0F;
  float far2 = 0.0F;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float low = corner[axis] - centre[axis];
    const float high = low + side;
    const float out = std::max({low, -high, 0.0F});
    const float across = std::max(std::abs(low), std::abs(high));
    near2 += out * out;
    far2 += across * across;
  }
  return {std::sqrt(near2), std::sqrt(far2)};
}

} // namespace

bool LeafFields::measure(const Puffs& puffs, std::span<const std::uint32_t> balls) {
  const float side = voxel_ * static_cast<float>(kSide - 1);
  float sure = -kOutside; // the leaf is at least this deep in the smoke everywhere
  float covering = 0.0F;
  for (const std::uint32_t ball : balls) {
    const float radius = puffs.radius[ball];
    const float depth = radius - reach(corner_, side, &puffs.position[3 * ball]).farthest;
    if (depth > sure) {
      sure = depth;
      covering = radius;
    }
  }
  distance_.fill(sure);
  radius_.fill(covering);
  if (sure >= kInside) {
    return true;
  }
  struct Candidate {
    float deepest; // the most depth that the ball can give to a voxel
    std::uint32_t ball;
  };
  std::vector<Candidate> candidates;
  for (const std::uint32_t ball : balls) {
    const float deepest =
        puffs.radius[ball] - reach(corner_, side, &puffs.position[3 * ball]).nearest;
    if (deepest > sure) {
      candidates.push_back({deepest, ball});
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.deepest != b.deepest ? a.deepest > b.deepest : a.ball < b.ball;
  });
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (i % 8 == 7) { // no later ball reaches deeper than the shallowest voxel lies already
      const float shallowest = *std::min_element(distance_.begin(), distance_.end());
      if (candidates[i].deepest <= std::min(shallowest, kInside)) {
        break;
      }
    }
    const std::uint32_t ball = candidates[i].ball;
    const float radius = puffs.radius[ball];
    const float* centre = &puffs.position[3 * ball];
    for (std::size_t x = 0; x < kSide; ++x) {
      const float dx = corner_[0] + static_cast<float>(x) * voxel_ - centre[0];
      for (std::size_t y = 0; y < kSide; ++y) {
        const float dy = corner_[1] + static_cast<float>(y) * voxel_ - centre[1];
        const float across = dx * dx + dy * dy;
        const std::size_t row = (x * kSide + y) * kSide;
        for (std::size_t z = 0; z < kSide; ++z) {
          const float dz = corner_[2] + static_cast<float>(z) * voxel_ - centre[2];
          const float depth = radius - std::sqrt(across + dz * dz);
          const bool deeper = depth > distance_[row + z];
          distance_[row + z] = deeper ? depth : distance_[row + z];
          radius_[row + z] = deeper ? radius : radius_[row + z];
        }
      }
    }
  }
  return sure > -kOutside || !candidates.empty();
}

std::array<double, 3> LeafFields::node(std::size_t x, std::size_t y, std::size_t z) const {
  const double step = 0.5 * static_cast<double>(kSide) * static_cast<double>(voxel_);
  return {static_cast<double>(corner_[0]) + static_cast<double>(x) * step,
          static_cast<double>(corner_[1]) + static_cast<double>(y) * step,
          static_cast<double>(corner_[2]) + static_cast<double>(z) * step};
}

template <typename Field> LeafFields::Nodes LeafFields::at_nodes(Field field) const {
  Nodes nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i] = field(node(i / (kNodes * kNodes), i / kNodes % kNodes, i % kNodes));
  }
  return nodes;
}

void LeafFields::interpolate(const Nodes& nodes, Values& values) {
  for (std::size_t i = 0; i < kVoxels; ++i) {
    const std::array<std::size_t, 3> voxel{i / (kSide * kSide), i / kSide % kSide, i % kSide};
    double sum = 0.0;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      double weight = 1.0;
      std::size_t at = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t step = corner >> axis & 1;
        const double part = static_cast<double>(voxel[axis] % 4) / 4.0;
        weight *= step == 1 ? part : 1.0 - part;
        at = at * kNodes + voxel[axis] / 4 + step;
      }
      sum += weight * nodes[at];
    }
    values[i] = static_cast<float>(sum);
  }
}

void LeafFields::concentrate(const Puffs& puffs, std::span<const std::uint32_t> balls) {
  const float side = voxel_ * static_cast<float>(kSide);
  std::vector<std::uint32_t> near;
  for (const std::uint32_t ball : balls) {
    if (puffs.mass[ball] > 0.0 &&
        reach(corner_, side, &puffs.position[3 * ball]).nearest < spread(puffs.radius[ball])) {
      near.push_back(ball);
    }
  }
  const Nodes nodes = at_nodes([&](const std::array<double, 3>& at) {
    double sum = 0.0;
    for (const std::uint32_t ball : near) {
      double distance2 = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double d = at[axis] - static_cast<double>(puffs.position[3 * ball + axis]);
        distance2 += d * d;
      }
      const double reach_m = static_cast<double>(spread(puffs.radius[ball]));
      const double part2 = distance2 / (reach_m * reach_m);
      const double rest = 1.0 - part2 * part2;
      if (rest > 0.0) {
        sum += puffs.mass[ball] * rest / (reach_m * reach_m * reach_m);
      }
    }
    return sum * 21.0 / (16.0 * std::numbers::pi);
  });
  interpolate(nodes, concentration_);
}

void LeafFields::light(const Flames& flames) {
  const float side = voxel_ * static_cast<float>(kSide);
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < flames.power.size(); ++i) {
    const std::array<float, 3> at{static_cast<float>(flames.position[3 * i]),
                                  static_cast<float>(flames.position[3 * i + 1]),
                                  static_cast<float>(flames.position[3 * i + 2])};
    if (reach(corner_, side, at.data()).nearest < kGlowReach) {
      near.push_back(i);
    }
  }
  if (near.empty()) {
    glow_.fill(0.0F);
    return;
  }
  interpolate(at_nodes([&](const std::array<double, 3>& at) {
                double sum = 0.0;
                for (const std::size_t i : near) {
                  double distance2 = 0.0;
                  for (std::size_t axis = 0; axis < 3; ++axis) {
                    const double d = at[axis] - flames.position[3 * i + axis];
                    distance2 += d * d;
                  }
                  sum += flames.power[i] * std::exp(-std::sqrt(distance2) / 1100.0) /
                         (distance2 + kGlowCore * kGlowCore);
                }
                return sum * kGlowCore * kGlowCore / kGlowPower;
              }),
              glow_);
}

} // namespace firetwin
