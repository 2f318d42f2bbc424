#include "flame.hpp"

#include "advection.hpp"
#include "combustion.hpp"
#include "filter.hpp"
#include "forces.hpp"
#include "fuel.hpp"

namespace flame_solver {
namespace {

constexpr float courant = 1.4F; ///< cells per step
constexpr float least_speed = 0.05F;
constexpr float damped_top = 0.8F; ///< share of the height from which the flow is calmed
constexpr int damped_side = 4;     ///< cells at open sides in which eddies fade

} // namespace

Flame::Flame(const Settings& s)
    : settings_(s), cell_(1.0F / static_cast<float>(s.cells)),
      flow_{Grid(s.nx + 1, s.ny, s.nz), Grid(s.nx, s.ny, s.nz), Grid(s.nx, s.ny, s.nz + 1)},
      mixture_(s.nx, s.ny, s.nz), temperature_(mixture_), expansion_(mixture_),
      fuel_(fuel_density(s)), pressure_(s.nx, s.ny, s.nz, s.wind > 0.0F) {
  for_each(flow_.u, [&](int i, int j, int k) {
    flow_.u(i, j, k) = wind_speed(s, (static_cast<float>(k) + 0.5F) * cell_);
  });
}

float Flame::longest_step() const {
  float fastest = least_speed;
  for (const Grid* grid : {&flow_.u, &flow_.v, &flow_.w}) {
    for (const float speed : grid->values) {
      fastest = std::max(fastest, std::abs(speed));
    }
  }
  return std::min(settings_.longest_step, courant * cell_ / fastest);
}

void Flame::advance(float duration) {
  carry_scalars(mixture_, temperature_, flow_, duration / cell_);
  carry_velocity(flow_, duration / cell_);
  for (Grid* grid : {&flow_.u, &flow_.v, &flow_.w}) {
    damp_grid_waves(*grid);
  }
  mix(mixture_, flow_, cell_, duration);
  add_fuel(duration);
  burn(mixture_, temperature_, expansion_, cell_, duration);
  add_forces(flow_, temperature_, fuel_, settings_, time_, duration);
  hold_boundaries(duration);
  pressure_.project(flow_, expansion_);
  time_ += duration;
}

void Flame::add_fuel(float duration) {
  if (settings_.crown != 0) {
    add_crown_fuel(mixture_, fuel_, settings_, time_, duration);
  } else {
    add_line_fuel(mixture_, settings_, time_, duration);
  }
}

/// Sets the inflow of wind, closes the ground, calms the flow below the top and at the sides.
void Flame::hold_boundaries(float duration) {
  const bool windy = settings_.wind > 0.0F;
  std::fill_n(flow_.w.values.begin(), static_cast<std::ptrdiff_t>(settings_.nx) * settings_.ny,
              0.0F);
  const int nx = settings_.nx, ny = settings_.ny, nz = settings_.nz;
  for (int k = 0; k < nz; ++k) {
    const float wind = wind_speed(settings_, (static_cast<float>(k) + 0.5F) * cell_);
    const float height = static_cast<float>(k) / static_cast<float>(nz);
    const float kept =
        1.0F - std::min(0.5F, duration * std::max(0.0F, (height - damped_top) / (1 - damped_top)));
    for (int j = 0; j < ny; ++j) {
      if (windy) {
        flow_.u(0, j, k) = wind;
      }
      if (kept < 1.0F) {
        for (int i = 0; i < nx; ++i) {
          flow_.u(i, j, k) = wind + (flow_.u(i, j, k) - wind) * kept;
          flow_.v(i, j, k) *= kept;
        }
      }
      for (int n = 0; n < damped_side; ++n) {
        for (const int i : {n, nx - 1 - n}) {
          if (i == n || !windy) {
            mixture_(i, j, k) *= 0.8F;
            flow_.v(i, j, k) *= 0.9F;
          }
        }
      }
    }
  }
}

} // namespace flame_solver
