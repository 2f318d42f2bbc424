#include "volume/smooth.hpp"

#include "base/clones.hpp"
#include "volume/lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace firetwin::volume {
namespace {

constexpr float glow_reach = 6000.0F; // m; exp(-6000 / 1100) is 0.4 %
constexpr float glow_fade = 1100.0F;  // m
constexpr float glow_core = 250.0F;   // m
constexpr double glow_power = 1.0e9;  // W
constexpr std::size_t row_count = 9;  // of nodes, along z

/// Node coordinates of a leaf along each axis, m; the fourth is a far-away dummy.
using Ticks = std::array<std::array<double, 4>, 3>;

Ticks ticks(const std::array<float, 3>& corner, float voxel_size) {
  const double step = 0.5 * static_cast<double>(leaf_side) * static_cast<double>(voxel_size);
  Ticks result{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < 4; ++i) {
      result[axis][i] = static_cast<double>(corner[axis]) + static_cast<double>(i) * step;
    }
  }
  return result;
}

/// Adds the weight max(0, 1 - (r^2 inverse)^2) of one puff at all nodes.
struct Puff {
  const double* position;
  double inverse;
  double weight;
};

FIRETWIN_CLONES("avx2")
void add_puffs(const Puff* puffs, std::size_t count, const Ticks& at, Nodes& sum) {
  std::array<WideLanes, row_count> rows{};
  WideLanes up;
  load(at[2].data(), up);
  for (std::size_t i = 0; i < count; ++i) {
    const Puff& puff = puffs[i];
    const WideLanes dz = up - puff.position[2];
    const WideLanes dz2 = dz * dz;
    for (std::size_t row = 0; row < row_count; ++row) {
      const double dx = at[0][row / 3] - puff.position[0];
      const double dy = at[1][row % 3] - puff.position[1];
      const WideLanes part2 = (dz2 + (dx * dx + dy * dy)) * puff.inverse;
      const WideLanes rest = 1.0 - part2 * part2;
      const WideLanes none{};
      rows[row] += (rest > none ? rest : none) * puff.weight;
    }
  }
  std::memcpy(sum.data(), rows.data(), sizeof rows);
}

/// Computes x -> exp(-x) for x >= 0 within 3e-7: a power of two times a polynomial of the remainder
/// (Taylor coefficients of 2^f for |f| <= 1/2).
inline void exp_negative(Lanes& x) {
  using Integers = Simd<std::int32_t, lane_count>;
  const Lanes y = x * std::numbers::log2e_v<float>;
  const Integers whole = __builtin_convertvector(y + 0.5F, Integers);
  const Lanes f = __builtin_convertvector(whole, Lanes) - y;
  Lanes power = 1.54035304e-4F * f + 1.33335581e-3F;
  power = power * f + 9.61812911e-3F;
  power = power * f + 5.55041087e-2F;
  power = power * f + 2.40226507e-1F;
  power = power * f + 6.93147181e-1F;
  power = power * f + 1.0F;
  const Integers bits = (127 - whole) << 23; // 2^-whole
  Lanes scale;
  load(&bits, scale);
  x = power * scale;
}

struct Light {
  std::array<float, 3> position; // m from the leaf's first voxel
  float power;
};

FIRETWIN_CLONES("avx2")
void add_lights(const Light* lights, std::size_t count, float step, Nodes& sum) {
  constexpr std::size_t group_count = 4; // 27 nodes in lanes
  std::array<Lanes, group_count> glow{};
  std::array<Lanes, group_count> x{};
  std::array<Lanes, group_count> y{};
  std::array<Lanes, group_count> z{};
  for (std::size_t node = 0; node < 27; ++node) {
    x[node / lane_count][node % lane_count] = static_cast<float>(node / 9) * step;
    y[node / lane_count][node % lane_count] = static_cast<float>(node / 3 % 3) * step;
    z[node / lane_count][node % lane_count] = static_cast<float>(node % 3) * step;
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t group = 0; group < group_count; ++group) {
      const Lanes dx = x[group] - lights[i].position[0];
      const Lanes dy = y[group] - lights[i].position[1];
      const Lanes dz = z[group] - lights[i].position[2];
      const Lanes distance2 = dx * dx + dy * dy + dz * dz;
      Lanes distance = distance2;
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        distance[lane] = std::sqrt(distance[lane]);
      }
      Lanes faded = distance * (1.0F / glow_fade);
      exp_negative(faded);
      glow[group] += faded * lights[i].power / (distance2 + glow_core * glow_core);
    }
  }
  for (std::size_t node = 0; node < 27; ++node) {
    sum[node / 3 * 4 + node % 3] = static_cast<double>(glow[node / lane_count][node % lane_count]);
  }
}

FIRETWIN_CLONES("avx2")
void interpolate_lanes(const Nodes& nodes, LeafValues& values) {
  WideLanes part; // fraction of the distance between two nodes
  for (std::size_t i = 0; i < 4; ++i) {
    part[i] = static_cast<double>(i) / 4.0;
  }
  std::array<std::array<WideLanes, 2>, row_count> rows; // eight voxels along z at each node (x, y)
  for (std::size_t row = 0; row < row_count; ++row) {
    for (std::size_t i = 0; i < 2; ++i) {
      const double low = nodes[row * 4 + i];
      rows[row][i] = (nodes[row * 4 + i + 1] - low) * part + low;
    }
  }
  for (std::size_t x = 0; x < leaf_side; ++x) {
    const double along = static_cast<double>(x % 4) / 4.0;
    std::array<std::array<WideLanes, 2>, 3> line; // at node y
    for (std::size_t y = 0; y < 3; ++y) {
      for (std::size_t i = 0; i < 2; ++i) {
        const WideLanes low = rows[x / 4 * 3 + y][i];
        line[y][i] = (rows[(x / 4 + 1) * 3 + y][i] - low) * along + low;
      }
    }
    for (std::size_t y = 0; y < leaf_side; ++y) {
      const double across = static_cast<double>(y % 4) / 4.0;
      float* out = &values[(x * leaf_side + y) * leaf_side];
      for (std::size_t i = 0; i < 2; ++i) {
        const WideLanes low = line[y / 4][i];
        const WideLanes value = (line[y / 4 + 1][i] - low) * across + low;
        for (std::size_t lane = 0; lane < 4; ++lane) {
          out[4 * i + lane] = static_cast<float>(value[lane]);
        }
      }
    }
  }
}

} // namespace

SpreadMass::SpreadMass(const Puffs& puffs, float voxel_size) : balls_(puffs.size()) {
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    const auto reach = static_cast<double>(spread(puffs.radius[i], voxel_size));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      balls_[i].position[axis] = static_cast<double>(puffs.position[3 * i + axis]);
    }
    balls_[i].inverse = 1.0 / (reach * reach);
    balls_[i].weight = puffs.mass[i] * 21.0 / (16.0 * std::numbers::pi) / (reach * reach * reach);
  }
}

Nodes SpreadMass::at_nodes(const std::array<float, 3>& corner, float voxel_size,
                           std::span<const std::uint32_t> balls) const {
  std::vector<Puff> puffs(balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Ball& ball = balls_[balls[i]];
    puffs[i] = {ball.position.data(), ball.inverse, ball.weight};
  }
  Nodes sum{};
  add_puffs(puffs.data(), puffs.size(), ticks(corner, voxel_size), sum);
  return sum;
}

Nodes glow_at_nodes(const std::array<float, 3>& corner, float voxel_size, const Flames& flames) {
  const float side = voxel_size * static_cast<float>(leaf_side);
  std::vector<Light> near;
  for (std::size_t i = 0; i < flames.power.size(); ++i) {
    Light light{};
    float gap2 = 0.0F;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      light.position[axis] =
          static_cast<float>(flames.position[3 * i + axis] - static_cast<double>(corner[axis]));
      const float gap = std::max({-light.position[axis], light.position[axis] - side, 0.0F});
      gap2 += gap * gap;
    }
    light.power = static_cast<float>(flames.power[i] * static_cast<double>(glow_core) *
                                     static_cast<double>(glow_core) / glow_power);
    if (gap2 < glow_reach * glow_reach) {
      near.push_back(light);
    }
  }
  Nodes sum{};
  add_lights(near.data(), near.size(), 0.5F * side, sum);
  return sum;
}

double largest(const Nodes& nodes) {
  double most = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    most = i % 4 < 3 ? std::max(most, nodes[i]) : most;
  }
  return most;
}

// Cloned functions must stay in this file.
void interpolate(const Nodes& nodes, LeafValues& values) {
  interpolate_lanes(nodes, values);
}

} // namespace firetwin::volume
