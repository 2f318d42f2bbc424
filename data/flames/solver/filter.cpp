#include "filter.hpp"

namespace flame_solver {
namespace {

constexpr float damping = 1.0F / 512.0F; ///< of a fourth difference, per step (by eye)

} // namespace

void damp_grid_waves(Grid& grid) {
  const Grid old = grid;
  for (int k = 2; k < grid.nz - 2; ++k) {
    for (int j = 0; j < grid.ny; ++j) {
      const int m = before(j, grid.ny), q = after(j, grid.ny);
      const int mm = before(m, grid.ny), qq = after(q, grid.ny);
      for (int i = 2; i < grid.nx - 2; ++i) {
        const float four = old(i - 1, j, k) + old(i + 1, j, k) + old(i, m, k) + old(i, q, k) +
                           old(i, j, k - 1) + old(i, j, k + 1);
        const float far = old(i - 2, j, k) + old(i + 2, j, k) + old(i, mm, k) + old(i, qq, k) +
                          old(i, j, k - 2) + old(i, j, k + 2);
        grid(i, j, k) -= damping * (far - 4.0F * four + 18.0F * old(i, j, k));
      }
    }
  }
}

} // namespace flame_solver
