#include "flow/buoyancy.hpp"

#include "base/clones.hpp"
#include "flow/parallel.hpp"

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

} // namespace

Buoyancy::Buoyancy(const Lattice& lattice, const Terrain& ground, const Ambient& ambient)
    : lattice_(lattice), ground_(ground), ambient_(ambient), force_(lattice, lattice.nz) {}

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

void Buoyancy::lift(State& state, float dt, Index k) const {
  for (Index j = 0; j < lattice_.ny; ++j) {
    push_row(lattice_.nx, force_.row(k - 1, j), force_.row(k, j), 0.5F * dt,
             state.wind.w.row(k, j));
  }
}

void Buoyancy::along_slope(State& state, float dt, Index k) const {
  const double share = ground_.share(lattice_.middle[static_cast<std::size_t>(k)]);
  const auto factor = static_cast<float>(0.5 * share / lattice_.spacing) * dt;
  for (Index j = 0; j < lattice_.ny; ++j) {
    const float* force = force_.row(k, j);
    float* u = state.wind.u.row(k, j);
    for (Index i = 1; i < lattice_.nx; ++i) {
      const auto rise = static_cast<float>(ground_.above(j, i) - ground_.above(j, i - 1));
      u[i] += (force[i - 1] + force[i]) * (factor * rise);
    }
    for (Index i = 0; j > 0 && i < lattice_.nx; ++i) {
      const auto rise = static_cast<float>(ground_.above(j, i) - ground_.above(j - 1, i));
      state.wind.v.row(k, j)[i] += (force_.row(k, j - 1)[i] + force[i]) * (factor * rise);
    }
  }
}

void Buoyancy::push(State& state, double dt) {
  each(lattice_.nz, [&](Index k) { compute_force(state, k); });
  each(lattice_.nz, [&](Index k) {
    if (k > 0) {
      lift(state, static_cast<float>(dt), k);
    }
    if (!ground_.flat()) {
      along_slope(state, static_cast<float>(dt), k);
    }
  });
}

} // namespace firetwin::flow
