#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace flame_solver {

/// Values on a lattice of nx by ny by nz points, x fastest.
struct Grid {
  int nx = 0, ny = 0, nz = 0;
  std::vector<float> values;

  Grid() = default;
  Grid(int x, int y, int z)
      : nx(x), ny(y), nz(z), values(static_cast<std::size_t>(x) * static_cast<std::size_t>(y) *
                                    static_cast<std::size_t>(z)) {}

  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(ny) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(nx) +
           static_cast<std::size_t>(i);
  }
  float& operator()(int i, int j, int k) { return values[index(i, j, k)]; }
  float operator()(int i, int j, int k) const { return values[index(i, j, k)]; }
};

/// Next and previous place along y, which is periodic.
inline int after(int j, int ny) {
  return j + 1 == ny ? 0 : j + 1;
}
inline int before(int j, int ny) {
  return j == 0 ? ny - 1 : j - 1;
}

/// Velocity on the faces of the cells: u on nx + 1, v on ny (periodic), w on nz + 1 planes.
struct Velocity {
  Grid u, v, w;
};

/// The eight lattice points around a place and their weights.
struct Corners {
  std::array<std::size_t, 8> at;
  std::array<float, 8> weight;

  [[nodiscard]] float mean(const std::vector<float>& values) const {
    float sum = 0.0F;
    for (std::size_t n = 0; n < 8; ++n) {
      sum += weight[n] * values[at[n]];
    }
    return sum;
  }
};

/// Finds the corners of a place in lattice coordinates: clamped along x and z, periodic along y.
inline Corners corners(const Grid& grid, float x, float y, float z) {
  constexpr float inside = 1.001F; // keeps the upper corner on the lattice
  x = std::clamp(x, 0.0F, static_cast<float>(grid.nx) - inside);
  z = std::clamp(z, 0.0F, static_cast<float>(grid.nz) - inside);
  const float floor = std::floor(y);
  const int i = static_cast<int>(x), k = static_cast<int>(z), whole = static_cast<int>(floor);
  const int j = (whole % grid.ny + grid.ny) % grid.ny;
  const float a = x - static_cast<float>(i), b = y - floor, c = z - static_cast<float>(k);
  const std::size_t near = grid.index(i, j, k), far = grid.index(i, after(j, grid.ny), k);
  const std::size_t up = static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny);
  const float p = (1 - a) * (1 - b), q = a * (1 - b), r = (1 - a) * b, s = a * b;
  return {{near, near + 1, far, far + 1, near + up, near + 1 + up, far + up, far + 1 + up},
          {p * (1 - c), q * (1 - c), r * (1 - c), s * (1 - c), p * c, q * c, r * c, s * c}};
}

/// Calls f(i, j, k) for all points of the lattice, x fastest.
template <class Function> void for_each(const Grid& grid, const Function& f) {
  for (int k = 0; k < grid.nz; ++k) {
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        f(i, j, k);
      }
    }
  }
}

} // namespace flame_solver
