#include "flow/subgrid_mixing.hpp"

#include "base/check.hpp"
#include "base/clones.hpp"
#include "flow/parallel.hpp"
#include "flow/thermodynamics.hpp"

#include <algorithm>
#include <cmath>

namespace firetwin::flow {
namespace {

/// Rows of wind and theta around one row of cells: the row itself and its neighbours in front,
/// behind, below and above. w is on the cells' lower and upper faces.
struct RowNeighbours {
  const float *u, *u_front, *u_back, *u_below, *u_above;
  const float *v, *v_next, *v_below, *v_next_below, *v_above, *v_next_above;
  const float *w, *w_up, *w_front, *w_up_front, *w_back, *w_up_back;
  const float *theta_below, *theta_above;
};

/// Inverse distances of finite differences, 1/m.
struct Spans {
  float across;   ///< a cell
  float depth;    ///< a cell
  float vertical; ///< from the level below to the level above
  float buoyancy; ///< 3 g / theta x `vertical`
  float east;     ///< shear of the ambient wind, 1/s
  float north;
  float length2; ///< (c d)^2, m2
};

FIRETWIN_CLONES("avx512f", "avx2")
void strength_row(Index n, const RowNeighbours& a, const Spans& s, float* __restrict out) {
  const float quarter = 0.25F * s.across, up = 0.5F * s.vertical;
  for (Index i = 0; i < n; ++i) {
    const float xx = (a.u[i + 1] - a.u[i]) * s.across;
    const float yy = (a.v_next[i] - a.v[i]) * s.across;
    const float zz = (a.w_up[i] - a.w[i]) * s.depth;
    const float xy = ((a.u_back[i] + a.u_back[i + 1]) - (a.u_front[i] + a.u_front[i + 1]) +
                      (a.v[i + 1] + a.v_next[i + 1]) - (a.v[i - 1] + a.v_next[i - 1])) *
                     quarter;
    const float xz = ((a.u_above[i] + a.u_above[i + 1]) - (a.u_below[i] + a.u_below[i + 1])) * up +
                     ((a.w[i + 1] + a.w_up[i + 1]) - (a.w[i - 1] + a.w_up[i - 1])) * quarter -
                     s.east;
    const float yz =
        ((a.v_above[i] + a.v_next_above[i]) - (a.v_below[i] + a.v_next_below[i])) * up +
        ((a.w_back[i] + a.w_up_back[i]) - (a.w_front[i] + a.w_up_front[i])) * quarter - s.north;
    const float shear2 = 2.0F * (xx * xx + yy * yy + zz * zz) + (xy * xy + xz * xz + yz * yz);
    const float rest = shear2 - (a.theta_above[i] - a.theta_below[i]) * s.buoyancy;
    out[i] = s.length2 * std::sqrt(rest > 0.0F ? rest : 0.0F);
  }
}

} // namespace

SubgridMixing::SubgridMixing(const Lattice& lattice, const Ambient& ambient, double strength)
    : lattice_(lattice), ambient_(ambient), strength_(strength) {
  check_zero_or_more(strength, "smagorinsky");
}

void SubgridMixing::level(const State& state, Index k, Field& out) const {
  const Index low = std::max(k - 1, Index{0}), high = std::min(k + 1, lattice_.nz - 1);
  const auto at = static_cast<std::size_t>(k);
  const double depth = lattice_.depth[at],
               d = std::cbrt(lattice_.spacing * lattice_.spacing * depth);
  const double span = lattice_.middle[static_cast<std::size_t>(high)] -
                      lattice_.middle[static_cast<std::size_t>(low)];
  const double theta = ambient_.reference() + static_cast<double>(ambient_.theta().row(k, 0)[0]);
  const auto shear = [&](std::size_t axis) {
    const auto& wind = ambient_.wind();
    return (wind[static_cast<std::size_t>(high)][axis] -
            wind[static_cast<std::size_t>(low)][axis]) /
           static_cast<float>(span);
  };
  const Spans spans{static_cast<float>(1.0 / lattice_.spacing),
                    static_cast<float>(1.0 / depth),
                    static_cast<float>(1.0 / span),
                    static_cast<float>(3.0 * constants::gravity / (theta * span)),
                    shear(0),
                    shear(1),
                    static_cast<float>(strength_ * strength_ * d * d)};
  const Field &u = state.wind.u, &v = state.wind.v, &w = state.wind.w;
  for (Index j = 0; j < lattice_.ny; ++j) {
    const RowNeighbours around{u.row(k, j),
                               u.row(k, j - 1),
                               u.row(k, j + 1),
                               u.row(low, j),
                               u.row(high, j),
                               v.row(k, j),
                               v.row(k, j + 1),
                               v.row(low, j),
                               v.row(low, j + 1),
                               v.row(high, j),
                               v.row(high, j + 1),
                               w.row(k, j),
                               w.row(k + 1, j),
                               w.row(k, j - 1),
                               w.row(k + 1, j - 1),
                               w.row(k, j + 1),
                               w.row(k + 1, j + 1),
                               state.theta.row(low, j),
                               state.theta.row(high, j)};
    strength_row(lattice_.nx, around, spans, out.row(k, j));
  }
}

void SubgridMixing::strengths(const State& state, Field& k) const {
  each(lattice_.nz, [&](Index level) { this->level(state, level, k); });
}

} // namespace firetwin::flow
