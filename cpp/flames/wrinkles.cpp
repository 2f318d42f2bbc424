#include "flames/wrinkles.hpp"

#include "base/clones.hpp"
#include "base/interpolation.hpp"
#include "base/noise.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace firetwin::flames {
namespace {

constexpr std::int64_t side = 32;                      ///< of the tile, nodes; a power of 2
constexpr float nodes = 2.0F;                          ///< to a cell
constexpr std::array<std::int64_t, 3> waves{16, 8, 4}; ///< nodes
constexpr float steep = 0.45F; ///< displacement over the wavelength (by eye)

using Shift = Simd<float, 4>;

/// Value at a node of the tile: the sum of its waves, cells.
Shift value_at(std::int64_t z, std::int64_t y, std::int64_t x) {
  Shift out{};
  for (std::size_t wave = 0; wave < waves.size(); ++wave) {
    const std::int64_t length = waves[wave], count = side / length;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto part = [&](std::int64_t at) {
        return static_cast<float>(at % length) / static_cast<float>(length);
      };
      const auto corner = [&](int k, int j, int i) {
        const auto number = [&](std::int64_t at, int next) {
          return static_cast<std::uint32_t>((at / length + next) % count);
        };
        const std::uint32_t seed = static_cast<std::uint32_t>(wave * 3 + axis) * 1000U;
        return cube_rise(jenkins_hash(number(x, i) + seed, number(y, j), number(z, k)),
                         part(x) - static_cast<float>(i), part(y) - static_cast<float>(j),
                         part(z) - static_cast<float>(k));
      };
      out[axis] += steep * static_cast<float>(length) / nodes *
                   gradient_noise(corner, part(z), part(y), part(x));
    }
  }
  return out;
}

const std::vector<Shift>& tile() {
  static const std::vector<Shift> values = [] {
    std::vector<Shift> out;
    for (std::int64_t n = 0; n < side * side * side; ++n) {
      out.push_back(value_at(n / (side * side), n / side % side, n % side));
    }
    return out;
  }();
  return values;
}

} // namespace

FIRETWIN_CLONES("avx2")
void wrinkle(Lanes& x, Lanes& y, Lanes& z, const Lanes& strength) {
  constexpr std::uint32_t mask = side - 1;
  const Shift* values = tile().data();
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const std::array<float, 3> at{x[lane] * nodes, y[lane] * nodes, z[lane] * nodes};
    std::array<std::array<std::uint32_t, 2>, 3> node;
    std::array<float, 3> part;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float low = std::floor(at[axis]);
      part[axis] = at[axis] - low;
      node[axis][0] = static_cast<std::uint32_t>(static_cast<std::int32_t>(low)) & mask;
      node[axis][1] = (node[axis][0] + 1U) & mask;
    }
    const auto corner = [&](int k, int j, int i) {
      const auto number = [&](std::size_t axis, int end) {
        return node[axis][static_cast<std::size_t>(end)];
      };
      return values[(number(2, k) * side + number(1, j)) * side + number(0, i)];
    };
    const Shift moved =
        trilinear(corner, Shift{} + part[2], Shift{} + part[1], Shift{} + part[0]) * strength[lane];
    x[lane] += moved[0];
    y[lane] += moved[1];
    z[lane] += moved[2];
  }
}

} // namespace firetwin::flames
