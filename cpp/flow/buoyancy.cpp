#include "flow/buoyancy.hpp"

#include "base/clones.hpp"

#include <vector>

namespace firetwin::flow {
namespace {

/// Computes g (theta - rest) / (rest + reference).
FIRETWIN_CLONES("avx512f", "avx2")
void weigh_row(Index n, const float* __restrict theta, const float* __restrict rest,
               float reference, float* __restrict force) {
  constexpr auto g = static_cast<float>(constants::gravity);
  for (Index i = 0; i < n; ++i) {
    force[i] = g * (theta[i] - rest[i]) / (rest[i] + reference);
  }
}

/// Computes g (virtual theta - rest) / rest.
FIRETWIN_CLONES("avx512f", "avx2")
void outweigh_row(Index n, const float* __restrict here, const float* __restrict rest,
                  float* __restrict force) {
  constexpr auto g = static_cast<float>(constants::gravity);
  for (Index i = 0; i < n; ++i) {
    force[i] = g * ((here[i] - rest[i]) / rest[i]);
  }
}

/// Computes q += (a + b) x half.
FIRETWIN_CLONES("avx512f", "avx2")
void push_row(Index n, const float* __restrict a, const float* __restrict b, float half,
              float* __restrict q) {
  for (Index i = 0; i < n; ++i) {
    q[i] += (a[i] + b[i]) * half;
  }
}

/// Computes q += (a + b) x (factor x rise).
FIRETWIN_CLONES("avx512f", "avx2")
void push_slope_row(Index n, const float* __restrict a, const float* __restrict b, float factor,
                    const float* __restrict rise, float* __restrict q) {
  for (Index i = 0; i < n; ++i) {
    q[i] += (a[i] + b[i]) * (factor * rise[i]);
  }
}

} // namespace

Buoyancy::Buoyancy(const Lattice& lattice, const Terrain& ground, const Ambient& ambient)
    : lattice_(lattice), ground_(ground), ambient_(ambient), force_(lattice, lattice.nz),
      rise_x_(lattice, 1), rise_y_(lattice, 1) {
  for (Index j = 0; j < lattice.ny; ++j) {
    for (Index i = 0; i < lattice.nx; ++i) {
      const double here = ground.above(j, i);
      rise_x_.row(0, j)[i] = i > 0 ? static_cast<float>(here - ground.above(j, i - 1)) : 0.0F;
      rise_y_.row(0, j)[i] = j > 0 ? static_cast<float>(here - ground.above(j - 1, i)) : 0.0F;
    }
  }
}

void Buoyancy::compute_force(const State& state, Index k) {
  std::vector<float> here(static_cast<std::size_t>(lattice_.nx)), cloud(here.size());
  for (Index j = 0; j < lattice_.ny; ++j) {
    const float* theta = state.theta.row(k, j);
    float* force = force_.row(k, j);
    if (!ambient_.moist()) {
      weigh_row(lattice_.nx, theta, ambient_.theta().row(k, j),
                static_cast<float>(ambient_.reference()), force);
      continue;
    }
    virtual_row(lattice_.nx, theta, state.water.row(k, j), ambient_.level_reference(k), here.data(),
                cloud.data());
    outweigh_row(lattice_.nx, here.data(), ambient_.virtual_theta().row(k, j), force);
  }
}

void Buoyancy::push(State& state, double dt, Index k) const {
  const double share = ground_.share(lattice_.middle[static_cast<std::size_t>(k)]);
  const auto step = static_cast<float>(dt);
  const float slope = static_cast<float>(0.5 * share / lattice_.spacing) * step;
  for (Index j = 0; j < lattice_.ny; ++j) {
    const float* force = force_.row(k, j);
    if (k > 0) {
      push_row(lattice_.nx, force_.row(k - 1, j), force, 0.5F * step, state.wind.w.row(k, j));
    }
    if (!ground_.flat()) {
      push_slope_row(lattice_.nx - 1, force, force + 1, slope, rise_x_.row(0, j) + 1,
                     state.wind.u.row(k, j) + 1);
    }
    if (!ground_.flat() && j > 0) {
      push_slope_row(lattice_.nx, force_.row(k, j - 1), force, slope, rise_y_.row(0, j),
                     state.wind.v.row(k, j));
    }
  }
}

} // namespace firetwin::flow
