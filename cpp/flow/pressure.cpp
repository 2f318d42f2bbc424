#include "flow/pressure.hpp"

#include "base/clones.hpp"
#include "flow/parallel.hpp"
#include "flow/rows.hpp"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

namespace firetwin::flow {
namespace {

constexpr Index chunk = 512; // modes solved together: their columns stay in the cache

/// FFTW makes plans one at a time.
std::mutex& planner() {
  static std::mutex mutex;
  return mutex;
}

struct Destroy {
  void operator()(fftwf_plan_s* plan) const {
    const std::lock_guard lock(planner());
    fftwf_destroy_plan(plan);
  }
};
using Plan = std::unique_ptr<fftwf_plan_s, Destroy>;

/// `count` transforms of n numbers that are `step` apart, `next` from one to the next. Estimated
/// and not measured, so that a plan, and every digit, is the same each time.
Plan plan(Index n, Index count, Index step, Index next, fftwf_r2r_kind kind, float* data) {
  const int length = static_cast<int>(n), s = static_cast<int>(step), d = static_cast<int>(next);
  const std::lock_guard lock(planner());
  return Plan(fftwf_plan_many_r2r(1, &length, static_cast<int>(count), data, nullptr, s, d, data,
                                  nullptr, s, d, &kind, FFTW_ESTIMATE | FFTW_UNALIGNED));
}

/// Of the second difference of cosine mode m of n, 1/m2.
double eigenvalue(Index m, Index n, double spacing) {
  const double s =
      std::sin(0.5 * std::numbers::pi * static_cast<double>(m) / static_cast<double>(n));
  return 4.0 * s * s / (spacing * spacing);
}

FIRETWIN_CLONES("avx512f", "avx2")
void eliminate(Index n, const float* __restrict lower, float below, const float* __restrict pivot,
               float* __restrict q) {
  for (Index i = 0; i < n; ++i) {
    q[i] = (q[i] - below * lower[i]) * pivot[i];
  }
}

FIRETWIN_CLONES("avx512f", "avx2")
void substitute(Index n, const float* __restrict upper, float above, const float* __restrict pivot,
                float* __restrict q) {
  for (Index i = 0; i < n; ++i) {
    q[i] -= above * pivot[i] * upper[i];
  }
}

} // namespace

struct Pressure::Plans {
  Plan x, y, x_back, y_back;
};

Pressure::Pressure(const Lattice& lattice, const Air& air)
    : lattice_(lattice), air_(air), size_((lattice.nx * lattice.ny + 15) / 16 * 16),
      modes_(static_cast<std::size_t>(size_ * lattice.nz)), pivot_(modes_.size()),
      below_(lattice.depth.size()), above_(lattice.depth.size()) {
  const Index nx = lattice.nx, ny = lattice.ny, nz = lattice.nz;
  float* data = modes_.data();
  plans_ = std::make_unique<Plans>(
      Plans{plan(nx, ny, 1, nx, FFTW_REDFT10, data), plan(ny, nx, nx, 1, FFTW_REDFT10, data),
            plan(nx, ny, 1, nx, FFTW_REDFT01, data), plan(ny, nx, nx, 1, FFTW_REDFT01, data)});
  for (Index k = 0; k < nz; ++k) {
    const auto at = static_cast<std::size_t>(k);
    below_[at] = k > 0 ? air.face[at] / static_cast<float>(lattice.gap(k)) : 0.0F;
    above_[at] = k + 1 < nz ? air.face[at + 1] / static_cast<float>(lattice.gap(k + 1)) : 0.0F;
  }
  each(ny, [&](Index j) {
    for (Index i = 0; i < nx; ++i) {
      const double wave = eigenvalue(i, nx, lattice.spacing) + eigenvalue(j, ny, lattice.spacing);
      double before = 0.0;
      for (Index k = 0; k < nz; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const double low = static_cast<double>(below_[at]), up = static_cast<double>(above_[at]);
        const double across = static_cast<double>(air.cell[at]) * wave;
        const bool free = i == 0 && j == 0 && k == nz - 1; // a constant: 0 at the top
        const double under = k > 0 ? static_cast<double>(above_[at - 1]) : 0.0;
        before = free ? 0.0 : 1.0 / (-(low + up + across) - low * under * before);
        pivot_[static_cast<std::size_t>(k * size_ + j * nx + i)] = static_cast<float>(before);
      }
    }
  });
}

Pressure::~Pressure() = default;

/// Air that leaves the cells of level k, kg/m2/s.
void Pressure::diverge(const Wind& wind, Index k, float* out) const {
  const auto at = static_cast<std::size_t>(k);
  const float across = air_.cell[at] / static_cast<float>(lattice_.spacing);
  for (Index j = 0; j < lattice_.ny; ++j) {
    const float* u = wind.u.row(k, j);
    const Faces faces{
        u, u + 1, wind.v.row(k, j), wind.v.row(k, j + 1), wind.w.row(k, j), wind.w.row(k + 1, j)};
    divergence_row(lattice_.nx, faces, across, air_.face[at + 1], air_.face[at],
                   out + j * lattice_.nx);
  }
}

double Pressure::divergence(const Wind& wind) const {
  return most_each(lattice_.nz, [&](Index k) {
    std::vector<float> out(static_cast<std::size_t>(size_));
    diverge(wind, k, out.data());
    return static_cast<double>(most_row(lattice_.nx * lattice_.ny, out.data())) /
           static_cast<double>(air_.cell[static_cast<std::size_t>(k)]);
  });
}

void Pressure::transform(bool back) {
  each(lattice_.nz, [&](Index k) {
    float* data = level(k);
    if (back) {
      fftwf_execute_r2r(plans_->y_back.get(), data, data);
      fftwf_execute_r2r(plans_->x_back.get(), data, data);
    } else {
      fftwf_execute_r2r(plans_->x.get(), data, data);
      fftwf_execute_r2r(plans_->y.get(), data, data);
    }
  });
}

void Pressure::solve_modes(Index begin, Index end) {
  const Index n = end - begin, nz = lattice_.nz;
  for (Index k = 0; k < nz; ++k) {
    float* q = level(k) + begin;
    const float* lower = k > 0 ? q - size_ : q;
    const float* pivot = pivot_.data() + k * size_ + begin;
    if (k == 0) {
      for (Index i = 0; i < n; ++i) {
        q[i] *= pivot[i];
      }
    } else {
      eliminate(n, lower, below_[static_cast<std::size_t>(k)], pivot, q);
    }
  }
  for (Index k = nz - 2; k >= 0; --k) {
    float* q = level(k) + begin;
    substitute(n, q + size_, above_[static_cast<std::size_t>(k)], pivot_.data() + k * size_ + begin,
               q);
  }
}

void Pressure::solve() {
  const Index modes = lattice_.nx * lattice_.ny;
  each((modes + chunk - 1) / chunk,
       [&](Index c) { solve_modes(c * chunk, std::min(modes, (c + 1) * chunk)); });
}

void Pressure::descend(Wind& wind) const {
  const Index nx = lattice_.nx, ny = lattice_.ny;
  const double whole = 4.0 * static_cast<double>(nx) * static_cast<double>(ny); // of transforms
  const auto across = static_cast<float>(1.0 / (lattice_.spacing * whole));
  each(lattice_.nz, [&](Index k) {
    const float* p = level(k);
    const float up = k > 0 ? static_cast<float>(1.0 / (lattice_.gap(k) * whole)) : 0.0F;
    for (Index j = 0; j < ny; ++j, p += nx) {
      descend_row(nx - 1, p + 1, p, across, wind.u.row(k, j) + 1);
      if (j > 0) {
        descend_row(nx, p, p - nx, across, wind.v.row(k, j));
      }
      if (k > 0) {
        descend_row(nx, p, p - size_, up, wind.w.row(k, j));
      }
    }
  });
}

void Pressure::project(Wind& wind) {
  each(lattice_.nz, [&](Index k) { diverge(wind, k, level(k)); });
  transform(false);
  solve();
  transform(true);
  descend(wind);
}

} // namespace firetwin::flow
