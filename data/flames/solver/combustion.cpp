#include "combustion.hpp"

#include "fuel.hpp"

namespace flame_solver {
namespace {

constexpr float smagorinsky = 0.10F;      ///< constant (by eye: lower than the usual 0.16)
constexpr float schmidt = 0.5F;           ///< turbulent Schmidt number (FDS's default)
constexpr float least_diffusion = 0.004F; ///< times a cell and sqrt(g unit) (by eye)
constexpr float stable = 0.15F;           ///< largest diffusion per step, of 1/6
constexpr float flame_excess = 3.2F;      ///< 940 K over air of 293 K: flames of 1,200 K (by eye)
constexpr float rich_fall =
    0.55F; ///< drop of the excess from stoichiometric gas to pure fuel (by eye)
constexpr float radiated = 0.35F, radiated_at = 1.2F; ///< share lost by radiation, and height
constexpr float most_cooling = -2.0F, most_expansion = 6.0F; ///< 1 / time
constexpr float still_top = 0.9F; ///< share of the box's height above which nothing expands

/// Strain rate of the flow in a cell, sqrt(2 S S), times the edge of a cell.
float strain(const Velocity& f, int i, int j, int k, int m, int q) {
  const Grid &u = f.u, &v = f.v, &w = f.w;
  const float xx = u(i + 1, j, k) - u(i, j, k), yy = v(i, q, k) - v(i, j, k),
              zz = w(i, j, k + 1) - w(i, j, k);
  const float xy = 0.125F * (u(i, q, k) + u(i + 1, q, k) - u(i, m, k) - u(i + 1, m, k) +
                             v(i + 1, j, k) + v(i + 1, q, k) - v(i - 1, j, k) - v(i - 1, q, k));
  const float xz =
      0.125F * (u(i, j, k + 1) + u(i + 1, j, k + 1) - u(i, j, k - 1) - u(i + 1, j, k - 1) +
                w(i + 1, j, k) + w(i + 1, j, k + 1) - w(i - 1, j, k) - w(i - 1, j, k + 1));
  const float yz = 0.125F * (v(i, j, k + 1) + v(i, q, k + 1) - v(i, j, k - 1) - v(i, q, k - 1) +
                             w(i, q, k) + w(i, q, k + 1) - w(i, m, k) - w(i, m, k + 1));
  return std::sqrt(2.0F * (xx * xx + yy * yy + zz * zz) + 4.0F * (xy * xy + xz * xz + yz * yz));
}

/// Temperature of burned gas over the flame's: rises to stoichiometric mixture, then falls.
float burned(float mixture) {
  mixture = std::max(mixture, 0.0F);
  return mixture < 1.0F ? mixture : 1.0F - rich_fall * (mixture - 1.0F) / (fuel_mixture - 1.0F);
}

} // namespace

void mix(Grid& mixture, const Velocity& flow, float cell, float duration) {
  const Grid z = mixture;
  for (int k = 1; k < z.nz - 1; ++k) {
    for (int j = 0; j < z.ny; ++j) {
      const int m = before(j, z.ny), q = after(j, z.ny);
      for (int i = 1; i < z.nx - 1; ++i) {
        const float own = z(i, j, k);
        const float sum = z(i - 1, j, k) + z(i + 1, j, k) + z(i, m, k) + z(i, q, k) +
                          z(i, j, k - 1) + z(i, j, k + 1) - 6.0F * own;
        if (sum == 0.0F) {
          continue;
        }
        const float eddy = smagorinsky * smagorinsky / schmidt * strain(flow, i, j, k, m, q);
        const float share = std::min((eddy + least_diffusion) * duration / cell, stable);
        mixture(i, j, k) = own + share * sum;
      }
    }
  }
}

void burn(const Grid& mixture, Grid& temperature, Grid& expansion, float cell, float duration) {
  for_each(mixture, [&](int i, int j, int k) {
    const float height = (static_cast<float>(k) + 0.5F) * cell;
    const float kept = 1.0F - radiated * std::min(1.0F, height / radiated_at);
    const float hot = flame_excess * burned(mixture(i, j, k)) * kept;
    const float rate = ((1.0F + hot) / (1.0F + temperature(i, j, k)) - 1.0F) / duration;
    const bool still = static_cast<float>(k) >= still_top * static_cast<float>(mixture.nz);
    expansion(i, j, k) = still ? 0.0F : cell * std::clamp(rate, most_cooling, most_expansion);
    temperature(i, j, k) = hot;
  });
}

} // namespace flame_solver
