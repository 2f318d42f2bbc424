#include "flow/diagnostics.hpp"

#include "flow/parallel.hpp"

#include <algorithm>
#include <vector>

namespace firetwin::flow {
namespace {

/// Sets out = f(k, j, i) for all cells.
template <class Function> void fill(const Solver& solver, std::span<float> out, const Function& f) {
  const Lattice& l = solver.lattice();
  each(l.nz, [&](Index k) {
    float* to = out.data() + k * l.ny * l.nx;
    for (Index j = 0; j < l.ny; ++j) {
      for (Index i = 0; i < l.nx; ++i) {
        *to++ = f(k, j, i);
      }
    }
  });
}

/// Computes the cloud water of row j of level k, kg/kg.
std::vector<float> cloud_row(const Solver& solver, const Field& theta, const Field& water, Index k,
                             Index j) {
  const Index n = solver.lattice().nx;
  std::vector<float> virtual_theta(static_cast<std::size_t>(n)), found(virtual_theta.size());
  if (solver.ambient().moist()) {
    virtual_row(n, theta.row(k, j), water.row(k, j), solver.ambient().level_reference(k),
                virtual_theta.data(), found.data());
  }
  return found;
}

/// Calls f(k, j, out) for all rows.
template <class Function>
void fill_rows(const Solver& solver, std::span<float> out, const Function& f) {
  const Lattice& l = solver.lattice();
  each(l.nz, [&](Index k) {
    for (Index j = 0; j < l.ny; ++j) {
      f(k, j, out.data() + (k * l.ny + j) * l.nx);
    }
  });
}

} // namespace

void smoke_density(const Solver& solver, std::span<float> out) {
  fill(solver, out, [&](Index k, Index j, Index i) {
    return static_cast<float>(static_cast<double>(solver.state().smoke.row(k, j)[i]) *
                              solver.ambient().density(k) / solver.ground().thickness(j, i));
  });
}

void smoke_age(const Solver& solver, std::span<float> out) {
  fill(solver, out, [&](Index k, Index j, Index i) {
    const float smoke = solver.state().smoke.row(k, j)[i];
    return smoke > 0.0F ? solver.state().age.row(k, j)[i] / smoke : 0.0F;
  });
}

void velocity(const Solver& solver, std::span<float> out) {
  const Lattice& l = solver.lattice();
  const Wind& wind = solver.state().wind;
  const Terrain& ground = solver.ground();
  each(l.nz, [&](Index k) {
    const double share = ground.share(l.middle[static_cast<std::size_t>(k)]) / l.spacing;
    float* to = out.data() + 3 * k * l.ny * l.nx;
    for (Index j = 0; j < l.ny; ++j) {
      for (Index i = 0; i < l.nx; ++i, to += 3) {
        const float* u = wind.u.row(k, j) + i;
        to[0] = 0.5F * (u[0] + u[1]);
        to[1] = 0.5F * (wind.v.row(k, j)[i] + wind.v.row(k, j + 1)[i]);
        const Index right = i + 1 < l.nx ? i + 1 : i, left = i > 0 ? i - 1 : i;
        const Index back = j + 1 < l.ny ? j + 1 : j, front = j > 0 ? j - 1 : j;
        const double east =
            (ground.above(j, right) - ground.above(j, left)) / static_cast<double>(right - left);
        const double north =
            (ground.above(back, i) - ground.above(front, i)) / static_cast<double>(back - front);
        const float rise = 0.5F * (wind.w.row(k, j)[i] + wind.w.row(k + 1, j)[i]);
        to[2] = static_cast<float>(static_cast<double>(rise) * ground.thickness(j, i)) +
                to[0] * static_cast<float>(east * share) +
                to[1] * static_cast<float>(north * share);
      }
    }
  });
}

void temperature_excess(const Solver& solver, std::span<float> out) {
  const Ambient& ambient = solver.ambient();
  constexpr double warming = latent_heat / constants::specific_heat;
  fill_rows(solver, out, [&](Index k, Index j, float* to) {
    const auto cloud = cloud_row(solver, solver.state().theta, solver.state().water, k, j);
    const auto rest = cloud_row(solver, ambient.theta(), ambient.water(), k, j);
    const float *here = solver.state().theta.row(k, j), *there = ambient.theta().row(k, j);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      to[i] = static_cast<float>(static_cast<double>(here[i] - there[i]) * ambient.exner(k) +
                                 warming * static_cast<double>(cloud[i] - rest[i]));
    }
  });
}

void cloud(const Solver& solver, std::span<float> out) {
  fill_rows(solver, out, [&](Index k, Index j, float* to) {
    const auto found = cloud_row(solver, solver.state().theta, solver.state().water, k, j);
    std::copy(found.begin(), found.end(), to);
  });
}

void heights(const Solver& solver, std::span<float> out) {
  const Terrain& ground = solver.ground();
  fill(solver, out, [&](Index k, Index j, Index i) {
    const double z = solver.lattice().middle[static_cast<std::size_t>(k)];
    return static_cast<float>(ground.mean() + z + ground.above(j, i) * ground.share(z));
  });
}

} // namespace firetwin::flow
