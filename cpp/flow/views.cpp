#include "flow/views.hpp"

#include "flow/parallel.hpp"
#include "flow/water.hpp"

namespace firetwin::flow {
namespace {

/// out = f(k, j, i) for all cells.
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

double water_of(const Solver& solver, const Field& water, Index k, Index j, Index i) {
  return solver.ambient().moist() ? static_cast<double>(water.row(k, j)[i]) : 0.0;
}

double cloud_of(const Solver& solver, Index k, double theta, double water) {
  double result = 0.0;
  solver.ambient().virtual_theta(k, theta, water, &result);
  return result;
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
  const Ground& ground = solver.ground();
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

void warmth(const Solver& solver, std::span<float> out) {
  const Ambient& ambient = solver.ambient();
  fill(solver, out, [&](Index k, Index j, Index i) {
    const auto excess = [&](const Field& theta, const Field& water) {
      const auto t = static_cast<double>(theta.row(k, j)[i]);
      const double condensed = cloud_of(solver, k, t, water_of(solver, water, k, j, i));
      return t * ambient.exner(k) + latent_heat / heat_capacity * condensed;
    };
    return static_cast<float>(excess(solver.state().theta, solver.state().water) -
                              excess(ambient.theta(), ambient.water()));
  });
}

void cloud(const Solver& solver, std::span<float> out) {
  fill(solver, out, [&](Index k, Index j, Index i) {
    return static_cast<float>(cloud_of(solver, k,
                                       static_cast<double>(solver.state().theta.row(k, j)[i]),
                                       water_of(solver, solver.state().water, k, j, i)));
  });
}

void heights(const Solver& solver, std::span<float> out) {
  const Ground& ground = solver.ground();
  fill(solver, out, [&](Index k, Index j, Index i) {
    const double z = solver.lattice().middle[static_cast<std::size_t>(k)];
    return static_cast<float>(ground.mean() + z + ground.above(j, i) * ground.share(z));
  });
}

} // namespace firetwin::flow
