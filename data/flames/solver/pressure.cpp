#include "pressure.hpp"

#include <fftw3.h>

#include <numbers>

namespace flame_solver {
namespace {

constexpr double pi = std::numbers::pi;

float divergence(const Velocity& f, int i, int j, int k) {
  return f.u(i + 1, j, k) - f.u(i, j, k) + f.v(i, after(j, f.v.ny), k) - f.v(i, j, k) +
         f.w(i, j, k + 1) - f.w(i, j, k);
}

/// Eigenvalue of the second difference for a wave whose phase changes by `angle` from cell to cell.
double second_difference(double angle) {
  return 2.0 * std::cos(angle) - 2.0;
}

} // namespace

/// Estimated plans, not measured ones, so that each digit of a result is reproducible.
struct Pressure::Plans {
  Plans(Grid& grid, bool inflow) {
    const std::array<int, 3> size{grid.nz, grid.ny, grid.nx};
    const std::array<fftwf_r2r_kind, 3> there{FFTW_REDFT11, FFTW_R2HC,
                                              inflow ? FFTW_REDFT11 : FFTW_RODFT10};
    const std::array<fftwf_r2r_kind, 3> back{FFTW_REDFT11, FFTW_HC2R,
                                             inflow ? FFTW_REDFT11 : FFTW_RODFT01};
    float* data = grid.values.data();
    forward = fftwf_plan_r2r(3, size.data(), data, data, there.data(), FFTW_ESTIMATE);
    backward = fftwf_plan_r2r(3, size.data(), data, data, back.data(), FFTW_ESTIMATE);
  }
  ~Plans() {
    fftwf_destroy_plan(forward);
    fftwf_destroy_plan(backward);
  }
  Plans(const Plans&) = delete;
  Plans& operator=(const Plans&) = delete;
  fftwf_plan forward, backward;
};

Pressure::Pressure(int nx, int ny, int nz, bool inflow)
    : inflow_(inflow), pressure_(nx, ny, nz), plans_(std::make_unique<Plans>(pressure_, inflow)) {
  for (int i = 0; i < nx; ++i) {
    along_x_.push_back(second_difference(pi * (inflow ? i + 0.5 : i + 1.0) / nx));
  }
  for (int j = 0; j < ny; ++j) {
    along_y_.push_back(second_difference(2.0 * pi * (j <= ny / 2 ? j : ny - j) / ny));
  }
  for (int k = 0; k < nz; ++k) {
    along_z_.push_back(second_difference(pi * (k + 0.5) / nz));
  }
}

Pressure::~Pressure() = default;

void Pressure::project(Velocity& flow, const Grid& expansion) {
  for_each(pressure_, [&](int i, int j, int k) {
    pressure_(i, j, k) = divergence(flow, i, j, k) - expansion(i, j, k);
  });
  solve();
  correct(flow);
}

void Pressure::solve() {
  const double scale = 0.25 / (static_cast<double>(pressure_.nx) * pressure_.ny * pressure_.nz);
  fftwf_execute(plans_->forward);
  for_each(pressure_, [&](int i, int j, int k) {
    const double sum = along_x_[static_cast<std::size_t>(i)] +
                       along_y_[static_cast<std::size_t>(j)] +
                       along_z_[static_cast<std::size_t>(k)];
    pressure_(i, j, k) *= static_cast<float>(scale / sum);
  });
  fftwf_execute(plans_->backward);
}

void Pressure::correct(Velocity& flow) const {
  const Grid& p = pressure_;
  const int end = p.nx - 1, top = p.nz - 1;
  for_each(p, [&](int i, int j, int k) {
    const float own = p(i, j, k);
    if (i > 0) {
      flow.u(i, j, k) -= own - p(i - 1, j, k);
    } else if (!inflow_) {
      flow.u(0, j, k) -= 2.0F * own; // no pressure half a cell outside
    }
    flow.v(i, j, k) -= own - p(i, before(j, p.ny), k);
    if (k > 0) {
      flow.w(i, j, k) -= own - p(i, j, k - 1);
    }
    if (i == end) {
      flow.u(p.nx, j, k) += 2.0F * own;
    }
    if (k == top) {
      flow.w(i, j, p.nz) += 2.0F * own;
    }
  });
}

float divergence_error(const Velocity& flow, const Grid& expansion) {
  float worst = 0.0F;
  for_each(expansion, [&](int i, int j, int k) {
    worst = std::max(worst, std::abs(divergence(flow, i, j, k) - expansion(i, j, k)));
  });
  return worst;
}

} // namespace flame_solver
