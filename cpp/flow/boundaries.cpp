#include "flow/boundaries.hpp"

#include "base/check.hpp"
#include "flow/parallel.hpp"
#include "flow/rows.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firetwin::flow {
namespace {

/// Computes (1 - distance / width)^2 for points 0 to count - 1, the first `offset` cells from the
/// side.
std::vector<float> weights(Index count, double offset, double width) {
  std::vector<float> result;
  for (Index i = 0; i < count; ++i) {
    const double distance = static_cast<double>(std::min(i, count - 1 - i)) + offset;
    const double rest = std::max(0.0, 1.0 - distance / width);
    result.push_back(static_cast<float>(rest * rest));
  }
  return result;
}

double share(double dt, double time) {
  return -std::expm1(-dt / time);
}

/// Calls f(first, n, weights) for each part of a row within the boundary zone, in full lanes:
/// weights beyond the zone are 0.
template <class Function>
void near_sides(const std::vector<float>& x, float y, Index reach, const Function& f) {
  const auto n = static_cast<Index>(x.size());
  const Index side = whole_lanes(reach);
  if (y > 0.0F) {
    std::vector<float> weight(x);
    for (float& w : weight) {
      w = std::max(w, y);
    }
    f(Index{0}, n, weight.data());
  } else if (2 * side > n) {
    f(Index{0}, n, x.data());
  } else {
    f(Index{0}, side, x.data());
    f(n - side, side, x.data() + (n - side));
  }
}

/// Copies ghost points of one row, `n` points from `first`.
void copy_ends(Index first, Index n, const float* from, float* to) {
  std::copy_n(from + first - halo, halo, to + first - halo);
  std::copy_n(from + first + n, halo, to + first + n);
}

void fill_ends(Index first, Index n, float value, float* to) {
  std::fill_n(to + first - halo, halo, value);
  std::fill_n(to + first + n, halo, value);
}

/// @param row first row of the field itself; @param value ambient value, used if `outside` is null
void ghosts(Field& field, const Field* outside, const Lattice& l, Index k, Index x, Index y,
            float value) {
  for (Index j = -halo; j < l.ny + halo; ++j) {
    const bool own = j >= y && j < l.ny;
    float* to = field.row(k, j);
    const float* from = outside ? outside->row(k, j) : nullptr;
    if (own && from) {
      copy_ends(x, l.nx - x, from, to);
    } else if (own) {
      fill_ends(x, l.nx - x, value, to);
    } else if (from) {
      std::copy_n(from - halo, l.nx + 2 * halo, to - halo);
    } else {
      std::fill_n(to - halo, l.nx + 2 * halo, value);
    }
  }
}

} // namespace

Boundaries::Boundaries(const Lattice& lattice, const Ambient& ambient, const RelaxationZone& zone)
    : lattice_(lattice), ambient_(ambient), zone_(zone),
      reach_(static_cast<Index>(std::ceil(zone.width)) + 1) {
  check_above_zero(zone.width, "sponge_width");
  check_above_zero(zone.time, "sponge_time");
  check_above_zero(zone.damping_time, "damping_time");
  check_above_zero(zone.drag_time, "drag_time");
  if (!(zone.damping_share >= 0.0 && zone.damping_share < 1.0)) {
    throw std::invalid_argument("damping_share must be at least 0 and less than 1");
  }
  if (2 * reach_ > std::min(lattice.nx, lattice.ny)) {
    throw std::invalid_argument("sponge_width must be less than half of the domain");
  }
  x_ = weights(lattice.nx, 0.5, zone.width);
  y_ = weights(lattice.ny, 0.5, zone.width);
  x_face_ = weights(lattice.nx + 1, 0.0, zone.width);
  y_face_ = weights(lattice.ny + 1, 0.0, zone.width);
}

void Boundaries::relax_level(State& state, const State* outside, double dt, Index k) const {
  const auto part = static_cast<float>(share(dt, zone_.time));
  const auto& ambient = ambient_.wind()[static_cast<std::size_t>(k)];
  const auto one = [&](Field& field, const Field* target, float value, const std::vector<float>& x,
                       const std::vector<float>& y) {
    for (Index j = 0; j < static_cast<Index>(y.size()); ++j) {
      near_sides(x, y[static_cast<std::size_t>(j)], reach_,
                 [&](Index first, Index n, const float* weight) {
                   float* q = field.row(k, j) + first;
                   if (target) {
                     relax_row(n, target->row(k, j) + first, weight, part, q);
                   } else {
                     relax_row(n, value, weight, part, q);
                   }
                 });
    }
  };
  one(state.wind.w, outside ? &outside->wind.w : nullptr, 0.0F, x_, y_);
  one(state.wind.u, outside ? &outside->wind.u : nullptr, ambient[0], x_face_, y_);
  one(state.wind.v, outside ? &outside->wind.v : nullptr, ambient[1], x_, y_face_);
  one(state.theta, outside ? &outside->theta : &ambient_.theta(), 0.0F, x_, y_);
  if (ambient_.moist()) {
    one(state.water, outside ? &outside->water : &ambient_.water(), 0.0F, x_, y_);
  }
}

void Boundaries::relax_top(State& state, double dt, Index k) const {
  const double begin = (1.0 - zone_.damping_share) * lattice_.top();
  const auto part = [&](double z) {
    const double rest = std::max(0.0, (z - begin) / (lattice_.top() - begin));
    return static_cast<float>(share(dt, zone_.damping_time) * rest * rest);
  };
  const auto at = static_cast<std::size_t>(k);
  const float faces = part(lattice_.face[at]), middles = part(lattice_.middle[at]);
  for (Index j = 0; middles > 0.0F && j < lattice_.ny; ++j) {
    float* w = state.wind.w.row(k, j);
    for (Index i = 0; i < lattice_.nx; ++i) {
      w[i] -= w[i] * faces;
    }
    relax_row(lattice_.nx, ambient_.theta().row(k, j), middles, state.theta.row(k, j));
  }
}

void Boundaries::relax(State& state, const State* outside, double dt, Index k) const {
  relax_level(state, outside, dt, k);
  relax_top(state, dt, k);
  if (k == 0) {
    const auto drag = static_cast<float>(share(dt, zone_.drag_time));
    const std::vector<float> all(static_cast<std::size_t>(lattice_.nx), 1.0F);
    for (Index j = 0; j < lattice_.ny; ++j) {
      relax_row(lattice_.nx, ambient_.wind()[0][0], all.data(), drag, state.wind.u.row(0, j));
      relax_row(lattice_.nx, ambient_.wind()[0][1], all.data(), drag, state.wind.v.row(0, j));
    }
  }
}

void Boundaries::fill_ghost_cells(State& state, const State* outside, Index k) const {
  const auto at = [&](auto member) { return outside ? &(outside->*member) : nullptr; };
  const Wind* around = outside ? &outside->wind : nullptr;
  const auto& wind = ambient_.wind()[static_cast<std::size_t>(k)];
  ghosts(state.wind.u, around ? &around->u : nullptr, lattice_, k, 1, 0, wind[0]);
  ghosts(state.wind.v, around ? &around->v : nullptr, lattice_, k, 0, 1, wind[1]);
  ghosts(state.wind.w, around ? &around->w : nullptr, lattice_, k, 0, 0, 0.0F);
  ghosts(state.smoke, at(&State::smoke), lattice_, k, 0, 0, 0.0F);
  ghosts(state.age, at(&State::age), lattice_, k, 0, 0, 0.0F);
  ghosts(state.theta, outside ? &outside->theta : &ambient_.theta(), lattice_, k, 0, 0, 0.0F);
  if (ambient_.moist()) {
    ghosts(state.water, outside ? &outside->water : &ambient_.water(), lattice_, k, 0, 0, 0.0F);
  }
}

void Boundaries::close(Wind& wind) const {
  wind.w.fill_level(0, 0.0F);
  wind.w.fill_level(lattice_.nz, 0.0F);
  balance(wind);
}

/// Adds one speed to the wind through all lateral faces, so that the net outflow is 0, as the
/// pressure projection requires.
void Boundaries::balance(Wind& wind) const {
  const Index nx = lattice_.nx, ny = lattice_.ny;
  double out = 0.0, area = 0.0;
  for (Index k = 0; k < lattice_.nz; ++k) {
    const auto mass = static_cast<double>(ambient_.air().cell[static_cast<std::size_t>(k)]);
    double level = sum_row(nx, wind.v.row(k, ny)) - sum_row(nx, wind.v.row(k, 0));
    for (Index j = 0; j < ny; ++j) {
      level += static_cast<double>(wind.u.row(k, j)[nx]) - static_cast<double>(wind.u.row(k, j)[0]);
    }
    out += level * mass;
    area += 2.0 * static_cast<double>(nx + ny) * mass;
  }
  const auto speed = static_cast<float>(out / area);
  if (speed == 0.0F) {
    return;
  }
  for (Index k = 0; k < lattice_.nz; ++k) {
    for (Index i = 0; i < nx; ++i) {
      wind.v.row(k, ny)[i] -= speed;
      wind.v.row(k, 0)[i] += speed;
    }
    for (Index j = 0; j < ny; ++j) {
      wind.u.row(k, j)[nx] -= speed;
      wind.u.row(k, j)[0] += speed;
    }
  }
}

} // namespace firetwin::flow
