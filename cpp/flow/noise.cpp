#include "flow/noise.hpp"

#include "base/clones.hpp"
#include "base/interpolation.hpp"
#include "base/noise.hpp"
#include "base/perlin.hpp"
#include "base/simd.hpp"

#include <algorithm>
#include <cmath>

namespace firetwin::flow {
namespace {

using namespace lattice_primes;

inline float share(std::uint32_t h, std::uint32_t shift) {
  return static_cast<float>(static_cast<std::int32_t>(h >> shift & 1023U)) * (1.0F / 1023.0F);
}

/// Offsets of the 27 cubes around a point, repeated to full lanes; padding has no points.
struct NeighbourCubes {
  static constexpr std::size_t middle = 13;
  std::array<std::int32_t, Worley::points> x{}, y{}, z{};
  constexpr NeighbourCubes() {
    for (std::size_t n = 0; n < 27; ++n) {
      const auto at = static_cast<std::int32_t>(n);
      x[n] = at % 3 - 1;
      y[n] = at / 3 % 3 - 1;
      z[n] = at / 9 - 1;
    }
  }
};

/// Computes how much farther each point is, at least, from any place in the middle cube than the
/// cube's own point: the difference of two squared distances is linear, so its minimum is at a
/// corner.
FIRETWIN_CLONES("avx512f", "avx2")
void strew(const std::array<std::int32_t, 3>& cell, std::uint32_t seed, Worley::Points& points,
           std::array<float, Worley::points>& farther) {
  static constexpr NeighbourCubes around;
  for (std::size_t n = 0; n < Worley::points; ++n) {
    const std::uint32_t h = murmur_finalizer(
        static_cast<std::uint32_t>(cell[0] + around.x[n]) * prime_x ^
        static_cast<std::uint32_t>(cell[1] + around.y[n]) * prime_y ^
        static_cast<std::uint32_t>(cell[2] + around.z[n]) * prime_z ^ seed * of_seed);
    points.x[n] = static_cast<float>(around.x[n]) + share(h, 0);
    points.y[n] = static_cast<float>(around.y[n]) + share(h, 10);
    points.z[n] = static_cast<float>(around.z[n]) + share(h, 20);
  }
  const float x = points.x[NeighbourCubes::middle], y = points.y[NeighbourCubes::middle],
              z = points.z[NeighbourCubes::middle];
  for (std::size_t n = 0; n < Worley::points; ++n) {
    const auto along = [](float p, float own) { // (p - own) (p + own - 2 t), t from 0 to 1
      return (p - own) * (p + own) - 2.0F * std::max(p - own, 0.0F);
    };
    farther[n] = along(points.x[n], x) + along(points.y[n], y) + along(points.z[n], z);
  }
}

/// Removes points that are nowhere the nearest in the middle cube: about half of them.
void drop_hidden_points(const std::array<float, Worley::points>& farther, Worley::Points& points) {
  constexpr float rounding = 1.0e-4F, far_away = 99.0F;
  constexpr std::size_t all = 27, together = 8;
  std::size_t count = 0;
  for (std::size_t n = 0; n < all; ++n) {
    points.x[count] = points.x[n];
    points.y[count] = points.y[n];
    points.z[count] = points.z[n];
    count += farther[n] < rounding ? 1 : 0;
  }
  points.count = (count + together - 1) / together * together;
  for (std::size_t n = count; n < points.count; ++n) {
    points.x[n] = points.y[n] = points.z[n] = far_away;
  }
}

using Lanes = Simd<float, 8>;

inline float nearest(const Worley::Points& points, float x, float y, float z) {
  Lanes least = Lanes{} + 9.0F;
  for (std::size_t n = 0; n < points.count; n += 8) {
    Lanes dx, dy, dz;
    load(points.x.data() + n, dx);
    load(points.y.data() + n, dy);
    load(points.z.data() + n, dz);
    dx -= x;
    dy -= y;
    dz -= z;
    const Lanes square = dx * dx + dy * dy + dz * dz;
    least = square < least ? square : least;
  }
  Lanes other = __builtin_shufflevector(least, least, 4, 5, 6, 7, 0, 1, 2, 3);
  least = other < least ? other : least;
  other = __builtin_shufflevector(least, least, 2, 3, 0, 1, 6, 7, 4, 5);
  least = other < least ? other : least;
  return std::min(least[0], least[1]);
}

} // namespace

FIRETWIN_CLONES("avx512f", "avx2")
void perlin(const Row& x, const Row& y, const Row& z, std::uint32_t seed, Row& noise) {
  for (std::size_t n = 0; n < noise.size(); ++n) {
    noise[n] = perlin_at(x[n], y[n], z[n], seed);
  }
}

const Worley::Points& Worley::around(const std::array<std::int32_t, 3>& cell, std::uint32_t seed) {
  Points& found =
      cache_[static_cast<std::size_t>((cell[0] & 3) | (cell[1] & 3) << 2 | (cell[2] & 15) << 4)];
  if (found.count == 0 || found.cell[0] != cell[0] || found.cell[1] != cell[1] ||
      found.cell[2] != cell[2] || found.seed != seed) {
    std::array<float, points> farther;
    strew(cell, seed, found, farther);
    drop_hidden_points(farther, found);
    found.cell = cell;
    found.seed = seed;
  }
  return found;
}

FIRETWIN_CLONES("avx512f", "avx2")
void Worley::at(const Row& x, const Row& y, const Row& z, std::uint32_t seed, Row& distance) {
  struct Axis {
    std::array<std::int32_t, Row{}.size()> cell;
    Row part;
  };
  std::array<Axis, 3> axes;
  const std::array<const Row*, 3> places{&x, &y, &z};
  for (std::size_t a = 0; a < axes.size(); ++a) {
    for (std::size_t n = 0; n < distance.size(); ++n) {
      const float at = (*places[a])[n], low = std::floor(at);
      axes[a].cell[n] = static_cast<std::int32_t>(low);
      axes[a].part[n] = at - low;
    }
  }
  const auto& [i, j, k] = axes;
  const Points* near = nullptr;
  for (std::size_t n = 0; n < distance.size(); ++n) {
    if (n == 0 || i.cell[n] != i.cell[n - 1] || j.cell[n] != j.cell[n - 1] ||
        k.cell[n] != k.cell[n - 1]) {
      near = &around({i.cell[n], j.cell[n], k.cell[n]}, seed);
    }
    distance[n] = nearest(*near, i.part[n], j.part[n], k.part[n]);
  }
  for (float& each : distance) {
    each = std::sqrt(each);
  }
}

} // namespace firetwin::flow
