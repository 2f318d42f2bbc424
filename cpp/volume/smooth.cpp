#include "volume/smooth.hpp"

#include "base/clones.hpp"
#include "base/simd.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace firetwin::volume {
namespace {

constexpr float glow_reach = 6000.0F; // m; exp(-6000 / 1100) is 0.4 %
constexpr float glow_fade = 1100.0F;  // m
constexpr float glow_core = 250.0F;   // m
constexpr double glow_power = 1.0e9;  // W
constexpr std::size_t row_count = 9;  // of nodes, along z

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

Nodes glow_at_nodes(const std::array<float, 3>& corner, float voxel_size,
                    const FlameLights& flames) {
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

void interpolate(const Nodes& nodes, LeafValues& values) {
  interpolate_lanes(nodes, values);
}

} // namespace firetwin::volume
