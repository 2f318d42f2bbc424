#include "flow/solver.hpp"

#include "base/check.hpp"
#include "base/error.hpp"
#include "flow/parallel.hpp"
#include "flow/rows.hpp"
#include "flow/thermodynamics.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace firetwin::flow {
namespace {

Terrain terrain_of(const Lattice& lattice, const std::vector<double>& height, const Solver* outer) {
  return outer ? Terrain(lattice, height, outer->ground()) : Terrain(lattice, height);
}

void check_sources(const Sources& s) {
  const std::size_t n = s.position.size();
  if (s.heat.size() != n || s.smoke.size() != n || (!s.water.empty() && s.water.size() != n)) {
    throw std::invalid_argument("heat, smoke and water must have one value for each position");
  }
  for (std::size_t i = 0; i < n; ++i) {
    check_finite(s.position[i], "position");
    check_zero_or_more(s.heat[i], "heat");
    check_zero_or_more(s.smoke[i], "smoke");
    if (!s.water.empty()) {
      check_zero_or_more(s.water[i], "water");
    }
  }
}

/// Computes a += (b - a) share, for complete rows.
void blend(const Lattice& l, const Field& b, float share, Field& a) {
  each(a.levels(), [&](Index k) {
    const float* from = b.row(k, -halo) - halo;
    relax_row(l.plane, from, share, a.row(k, -halo) - halo);
  });
}

/// Adds a wind to each level.
void shift(const Lattice& l, const std::vector<std::array<float, 2>>& change, Wind& wind) {
  each(l.nz, [&](Index k) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const float more = change[static_cast<std::size_t>(k)][axis];
      float* values = (axis == 0 ? wind.u : wind.v).row(k, -halo) - halo;
      for (Index i = 0; i < l.plane; ++i) {
        values[i] += more;
      }
    }
  });
}

} // namespace

SolverSettings nest_settings() {
  SolverSettings settings;
  settings.relaxation.width = 10.0;
  settings.relaxation.time = 8.0;
  return settings;
}

Solver::Solver(Domain domain, Profile profile, const SolverSettings& settings)
    : Solver(std::move(domain), std::move(profile), settings, nullptr) {}

Solver::Solver(Domain domain, const std::shared_ptr<const Solver>& outer,
               const SolverSettings& settings)
    : Solver(std::move(domain), outer->profile(), settings, outer) {}

Solver::Solver(Domain domain, Profile profile, const SolverSettings& settings,
               std::shared_ptr<const Solver> outer)
    : lattice_(domain.nx, domain.ny, domain.spacing, std::move(domain.levels)),
      corner_(domain.corner), profile_(std::move(profile)), settings_(settings),
      outer_(std::move(outer)), ground_(terrain_of(lattice_, domain.ground, outer_.get())),
      ambient_(lattice_, ground_, profile_), state_(lattice_, ambient_.moist()),
      transport_(lattice_, ambient_.air()), pressure_(lattice_, ambient_.air()),
      mixing_(lattice_, ambient_, settings.smagorinsky), buoyancy_(lattice_, ground_, ambient_),
      boundaries_(lattice_, ambient_, settings.relaxation),
      shares_(shares(lattice_, settings.source_depth)) {
  check_finite(corner_, "corner");
  check_above_zero(settings.source_depth, "source_depth");
  check_zero_or_more(settings.gusts.strength, "gust_strength");
  check_above_zero(settings.gusts.size, "gust_size");
  check_above_zero(settings.gusts.time, "gust_time");
  initialize();
}

/// Starts from rest with the ambient wind, or from the outer flow.
void Solver::initialize() {
  if (outer_) {
    nest_interpolator_.emplace(outer_->lattice_, outer_->corner_, outer_->ambient_, lattice_,
                               corner_, ambient_);
    nest_interpolator_->interpolate(outer_->state_, state_, lattice_.nx);
    outside_ = std::make_unique<State>(lattice_, ambient_.moist());
    next_outer_ = std::make_unique<State>(lattice_, ambient_.moist());
    nest_interpolator_->interpolate(outer_->state_, *outside_, boundaries_.reach());
    time_ = outer_->time_;
    outer_step_ = outer_->steps_;
  } else {
    state_.theta = ambient_.theta();
    state_.water = ambient_.water();
    for (Index k = 0; k < lattice_.nz; ++k) {
      state_.wind.u.fill_level(k, ambient_.wind()[static_cast<std::size_t>(k)][0]);
      state_.wind.v.fill_level(k, ambient_.wind()[static_cast<std::size_t>(k)][1]);
    }
  }
  fill_ghost_cells();
  pressure_.project(state_.wind);
  mass_.initial = airborne();
}

void Solver::set_sources(Sources sources) {
  check_sources(sources);
  if (!ambient_.moist()) {
    sources.water.clear();
  }
  sources_ = std::move(sources);
}

void Solver::set_wind(const std::vector<std::array<double, 2>>& wind) {
  if (wind.size() != profile_.height.size()) {
    throw std::invalid_argument("wind must have one vector for each height of the profile");
  }
  for (const auto& w : wind) {
    check_finite(w, "wind");
  }
  profile_.wind = wind;
  const auto change = ambient_.set_wind(lattice_, profile_);
  shift(lattice_, change, state_.wind);
  if (outside_) {
    shift(lattice_, change, outside_->wind);
  }
}

/// Interpolates the outer flow in time, to the end of the nest's step.
void Solver::follow_outer(double dt) {
  if (!outer_) {
    return;
  }
  if (outer_->profile_.wind != profile_.wind) {
    set_wind(outer_->profile_.wind);
  }
  if (outer_step_ != outer_->steps_) {
    nest_interpolator_->interpolate(outer_->state_, *next_outer_, boundaries_.reach());
    outer_step_ = outer_->steps_;
  }
  const double ahead = outer_->time_ - time_;
  if (dt > ahead * (1.0 + 1e-6) + 1e-6) {
    throw std::invalid_argument(
        "the nest would overtake the outer flow; step the outer flow first");
  }
  State& now = *outside_;
  if (ahead - dt < 1e-6) {
    now = *next_outer_;
    return;
  }
  const auto share = static_cast<float>(dt / ahead);
  blend(lattice_, next_outer_->wind.u, share, now.wind.u);
  blend(lattice_, next_outer_->wind.v, share, now.wind.v);
  blend(lattice_, next_outer_->wind.w, share, now.wind.w);
  blend(lattice_, next_outer_->theta, share, now.theta);
  blend(lattice_, next_outer_->smoke, share, now.smoke);
  blend(lattice_, next_outer_->age, share, now.age);
  blend(lattice_, next_outer_->water, share, now.water);
}

void Solver::carry(double dt) {
  const std::array<Field*, 4> dry{&state_.smoke, &state_.age, &state_.theta, &state_.water};
  const std::array<Field*, 4> moist{&state_.smoke, &state_.age, &state_.water, &state_.theta};
  std::array<BoundaryFlux, 4> crossed{};
  const std::size_t count = ambient_.moist() ? 4 : 3;
  Field* mixing = nullptr;
  if (mixing_.on()) {
    mixing = &buoyancy_.scratch();
    mixing_.strengths(state_, *mixing);
  }
  const auto fields = std::span(ambient_.moist() ? moist : dry).first(count);
  substeps_ = transport_.advance(state_.wind, fields, 1, dt, steps_ % 2 == 1, crossed, mixing);
  mass_.entered += crossed[0].in;
  mass_.left += crossed[0].out;
}

void Solver::add_to_level(const Deposit& deposit, double dt, Index k) {
  const auto at = static_cast<std::size_t>(k);
  const double air = ambient_.density(k) * lattice_.depth[at] * lattice_.spacing * lattice_.spacing;
  const double part = dt * shares_[at] / air;
  const double warming = part / (constants::specific_heat * ambient_.exner(k));
  for (Index j = 0; j < lattice_.ny; ++j) {
    for (Index i = 0; i < lattice_.nx; ++i) {
      const auto column = static_cast<std::size_t>(j * lattice_.nx + i);
      const auto add = [&](Field& field, double amount) {
        float& value = field.row(k, j)[i];
        value = static_cast<float>(static_cast<double>(value) + amount);
        field.empty(k, j) = 0;
      };
      if (deposit.heat[column] > 0.0) {
        add(state_.theta, warming * deposit.heat[column]);
      }
      if (deposit.smoke[column] > 0.0) {
        add(state_.smoke, part * deposit.smoke[column]);
      }
      if (!deposit.water.empty() && deposit.water[column] > 0.0) {
        add(state_.water, part * deposit.water[column]);
      }
    }
  }
}

/// Ages the smoke, adds what sources release, and computes buoyancy. @return airborne smoke, kg
double Solver::add_sources(double dt) {
  const bool burns = !sources_.position.empty();
  const Deposit now =
      burns ? deposit(sources_, lattice_, corner_, settings_.gusts, time_ + 0.5 * dt) : Deposit{};
  double heat = 0.0, smoke = 0.0, warmed = 0.0;
  for (std::size_t i = 0; i < now.heat.size(); ++i) {
    heat += now.heat[i];
    smoke += now.smoke[i];
  }
  for (std::size_t k = 0; k < shares_.size(); ++k) {
    warmed += shares_[k] / ambient_.exner(static_cast<Index>(k));
  }
  mass_.emitted += smoke * dt;
  heat_.given += heat * dt;
  heat_.warmed += heat * dt * warmed;
  return sum_each(lattice_.nz, [&](Index k) {
    for (Index j = 0; j < lattice_.ny; ++j) {
      if (state_.smoke.empty(k, j) && state_.age.empty(k, j)) {
        continue;
      }
      state_.age.empty(k, j) = 0;
      age_row(lattice_.nx, state_.smoke.row(k, j), static_cast<float>(dt),
              static_cast<float>(time_ + dt), state_.age.row(k, j));
    }
    if (burns && shares_[static_cast<std::size_t>(k)] > 0.0) {
      add_to_level(now, dt, k);
    }
    buoyancy_.compute_force(state_, k);
    return airborne(k);
  });
}

/// Applies buoyancy and boundary conditions, level by level while it is in the cache, and projects
/// the wind.
void Solver::accelerate(double dt) {
  each(lattice_.nz, [&](Index k) {
    buoyancy_.push(state_, dt, k);
    boundaries_.relax(state_, outside_.get(), dt, k);
    boundaries_.fill_ghost_cells(state_, outside_.get(), k);
  });
  boundaries_.close(state_.wind);
  pressure_.project(state_.wind);
}

void Solver::fill_ghost_cells() {
  state_.smoke.clear_empty();
  state_.age.clear_empty();
  each(lattice_.nz, [&](Index k) { boundaries_.fill_ghost_cells(state_, outside_.get(), k); });
  boundaries_.close(state_.wind);
}

void Solver::step(double dt) {
  check_above_zero(dt, "dt");
  follow_outer(dt);
  carry(dt);
  const double is = add_sources(dt);
  accelerate(dt);
  time_ += dt;
  ++steps_;
  const double should = mass_.initial + mass_.emitted + mass_.entered + mass_.rounding - mass_.left;
  if (!std::isfinite(is) || !std::isfinite(courant())) {
    throw Error("the flow has diverged to infinity; use a shorter time step");
  }
  mass_.rounding += is - should;
}

/// Airborne smoke of level k, kg.
double Solver::airborne(Index k) const {
  double sum = 0.0;
  for (Index j = 0; j < lattice_.ny; ++j) {
    sum += state_.smoke.empty(k, j) ? 0.0 : sum_row(lattice_.nx, state_.smoke.row(k, j));
  }
  return sum * static_cast<double>(ambient_.air().cell[static_cast<std::size_t>(k)]) *
         (lattice_.spacing * lattice_.spacing);
}

double Solver::airborne() const {
  return sum_each(lattice_.nz, [&](Index k) { return airborne(k); });
}

MassBudget Solver::mass() const {
  MassBudget result = mass_;
  result.airborne = airborne();
  return result;
}

HeatBudget Solver::heat() const {
  HeatBudget result = heat_;
  const double area = lattice_.spacing * lattice_.spacing;
  result.held = sum_each(lattice_.nz, [&](Index k) {
    double sum = 0.0;
    for (Index j = 0; j < lattice_.ny; ++j) {
      sum += sum_row(lattice_.nx, state_.theta.row(k, j)) -
             sum_row(lattice_.nx, ambient_.theta().row(k, j));
    }
    return sum * static_cast<double>(ambient_.air().cell[static_cast<std::size_t>(k)]) * area *
           constants::specific_heat;
  });
  return result;
}

Solver::Checkpoint Solver::checkpoint() const {
  return {time_, steps_, mass_, heat_};
}

void Solver::restore(const Checkpoint& checkpoint, const std::vector<std::array<double, 2>>& wind) {
  if (wind.size() != profile_.height.size()) {
    throw std::invalid_argument("wind must have one vector for each height of the profile");
  }
  if (outer_ && std::abs(checkpoint.time - outer_->time_) > 1e-6) {
    throw std::invalid_argument(
        "the outer flow is at another time; restore it first, from the same time");
  }
  profile_.wind = wind;
  ambient_.set_wind(lattice_, profile_);
  if (outer_) {
    nest_interpolator_->interpolate(outer_->state_, *outside_, boundaries_.reach());
    outer_step_ = outer_->steps_;
  }
  time_ = checkpoint.time;
  steps_ = checkpoint.steps;
  mass_ = checkpoint.mass;
  heat_ = checkpoint.heat;
}

} // namespace firetwin::flow
