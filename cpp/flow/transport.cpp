#include "flow/transport.hpp"

#include "base/error.hpp"
#include "flow/parallel.hpp"
#include "flow/rows.hpp"

#include <algorithm>
#include <cmath>

namespace firetwin::flow {
namespace {

constexpr double most_courant = 0.8;
constexpr double max_drained =
    0.75; // share of a cell's air that may leave through both sides; a face may pass a quarter more
constexpr int most_substeps = 1000;
constexpr float most_mixing =
    0.15F; // share of the air of the smaller cell at a face; three times that for scalars

/// Returns the number of leading sparse fields: smoke and its age come first.
std::size_t sparse(Place place) {
  return place == Place::middle ? 2 : 0;
}

} // namespace

Transport::Transport(const Lattice& lattice, const Air& air)
    : lattice_(lattice), air_(air), x_(lattice, lattice.nz), y_(lattice, lattice.nz),
      z_(lattice, lattice.nz + 1), rest_(lattice, lattice.nz), first_(lattice, lattice.nz),
      second_(lattice, lattice.nz), mix_x_(lattice, lattice.nz), mix_y_(lattice, lattice.nz),
      mix_z_(lattice, lattice.nz + 1) {
  for (Index k = 0; k < lattice.nz; ++k) {
    const float mass = air.cell[static_cast<std::size_t>(k)];
    rest_.fill_level(k, mass);
    first_.fill_level(k, mass);
    second_.fill_level(k, mass);
  }
}

const Field& Transport::flux(Axis axis) const {
  return axis == Axis::x ? x_ : axis == Axis::y ? y_ : z_;
}

const Field* Transport::exchange(Axis axis) const {
  return !mixes_ ? nullptr : axis == Axis::x ? &mix_x_ : axis == Axis::y ? &mix_y_ : &mix_z_;
}

/// Computes eddy exchange. It is 0 through the domain's faces, and limited by the air that is left
/// where one direction has drained a cell.
void Transport::exchanges(const Field& mixing, double dt) {
  const double across = dt / (lattice_.spacing * lattice_.spacing);
  const auto one = [&](Index k, Index j, Index first, Index down, Index front, Index left,
                       float factor, Field& out) {
    const auto at = [&](const Field& field, Index back) {
      return field.row(k - back * down, j - back * front) + first - back * left;
    };
    exchange_row(lattice_.nx - first, {at(mixing, 1), at(mixing, 0)},
                 {at(first_, 1), at(first_, 0), at(second_, 1), at(second_, 0)}, factor,
                 most_mixing, out.row(k, j) + first);
  };
  each(lattice_.nz, [&](Index k) {
    const auto at = static_cast<std::size_t>(k);
    const float level = air_.cell[at] * static_cast<float>(across);
    const float up = k > 0 ? air_.face[at] * static_cast<float>(dt / lattice_.gap(k)) : 0.0F;
    for (Index j = 0; j < lattice_.ny; ++j) {
      one(k, j, 1, 0, 0, 1, level, mix_x_);
      if (j > 0) {
        one(k, j, 0, 0, 1, 0, level, mix_y_);
      }
      if (k > 0) {
        one(k, j, 0, 1, 0, 0, up, mix_z_);
      }
    }
  });
}

/// Returns the largest Courant number of a step.
double Transport::max_courant(const Wind& wind, double dt) const {
  const auto mass = [&](Index k) {
    return static_cast<double>(air_.cell[static_cast<std::size_t>(k)]);
  };
  return max_each(lattice_.nz, [&](Index k) {
    const double up = static_cast<double>(air_.face[static_cast<std::size_t>(k)]) /
                      (k > 0 ? std::min(mass(k - 1), mass(k)) : mass(k));
    float across = 0.0F, along = 0.0F;
    for (Index j = 0; j <= lattice_.ny; ++j) {
      across = std::max(across, max_abs_row(lattice_.nx, wind.v.row(k, j)));
      if (j < lattice_.ny) {
        across = std::max(across, max_abs_row(lattice_.nx + 1, wind.u.row(k, j)));
        along = std::max(along, max_abs_row(lattice_.nx, wind.w.row(k, j)));
      }
    }
    return dt * std::max(static_cast<double>(across) / lattice_.spacing,
                         static_cast<double>(along) * up);
  });
}

void Transport::fluxes(const Wind& wind, double dt) {
  const double along = dt / lattice_.spacing;
  each(lattice_.nz, [&](Index k) {
    const auto at = static_cast<std::size_t>(k);
    const auto factor = static_cast<float>(static_cast<double>(air_.cell[at]) * along);
    const auto up = static_cast<float>(static_cast<double>(air_.face[at]) * dt);
    for (Index j = 0; j <= lattice_.ny; ++j) {
      scale_row(lattice_.nx, wind.v.row(k, j), factor, y_.row(k, j));
      if (j < lattice_.ny) {
        scale_row(lattice_.nx + 1, wind.u.row(k, j), factor, x_.row(k, j));
        scale_row(lattice_.nx, wind.w.row(k, j), up, z_.row(k, j));
      }
    }
  });
}

/// Computes the air of cells after one more direction. @return the largest share of air that a cell
/// lost
double Transport::drain(Axis axis, const Field& before, Field& after) {
  const Field& through = flux(axis);
  return max_each(lattice_.nz, [&](Index k) {
    float least = 1.0F;
    for (Index j = 0; j < lattice_.ny; ++j) {
      const float* in = through.row(k, j);
      const float* out = axis == Axis::x   ? in + 1
                         : axis == Axis::y ? through.row(k, j + 1)
                                           : through.row(k + 1, j);
      remaining_row(lattice_.nx, before.row(k, j), in, out, after.row(k, j));
      least = std::min(least, min_ratio_row(lattice_.nx, after.row(k, j), before.row(k, j)));
    }
    return 1.0 - static_cast<double>(least);
  });
}

/// Returns the largest share that cells lose in the last direction, after which they have the air
/// at rest.
double Transport::drain_last(const Field& before) const {
  return max_each(lattice_.nz, [&](Index k) {
    const float rest = air_.cell[static_cast<std::size_t>(k)];
    float most = rest;
    for (Index j = 0; j < lattice_.ny; ++j) {
      most = std::max(most, max_abs_row(lattice_.nx, before.row(k, j)));
    }
    return 1.0 - static_cast<double>(rest / most);
  });
}

int Transport::prepare(const Wind& wind, double dt, bool backwards) {
  courant_ = max_courant(wind, dt);
  for (int substeps = std::max(1, static_cast<int>(std::ceil(courant_ / most_courant)));;
       substeps *= 2) {
    fluxes(wind, dt / substeps);
    const double one = drain(backwards ? Axis::z : Axis::x, rest_, first_);
    const double two = drain(Axis::y, first_, second_);
    if (std::max({one, two, drain_last(second_)}) < max_drained || substeps >= most_substeps) {
      return substeps;
    }
  }
}

void Transport::levels(Wind& wind, std::span<Field* const> scalars, std::size_t conserved,
                       bool backwards, std::span<BoundaryFlux> crossed) {
  const std::array<Axis, 2> order =
      backwards ? std::array{Axis::y, Axis::x} : std::array{Axis::x, Axis::y};
  const std::array<const Field*, 2> mass = backwards
                                               ? std::array<const Field*, 2>{&first_, &second_}
                                               : std::array<const Field*, 2>{&rest_, &first_};
  const std::size_t count = scalars.size();
  each(lattice_.nz, [&](Index k) {
    for (std::size_t n = 0; n < 2; ++n) {
      const bool last = backwards && n == 1;
      const auto go = [&](Place place, std::span<Field* const> fields, std::size_t rescaled) {
        const auto rest = last ? std::span<const float>(air_.cell) : std::span<const float>();
        const bool counts = place == Place::middle;
        sweep_level({lattice_, order[n], place, flux(order[n]), *mass[n], rest, fields, rescaled,
                     sparse(place), exchange(order[n]), counts ? scalar_mixing : 1.0F},
                    k,
                    counts ? crossed.subspan(static_cast<std::size_t>(k) * count, count)
                           : std::span<BoundaryFlux>());
      };
      const std::array<Field*, 3> parts{&wind.u, &wind.v, &wind.w};
      go(Place::middle, scalars, conserved);
      go(Place::x, std::span(parts).subspan(0, 1), 0);
      go(Place::y, std::span(parts).subspan(1, 1), 0);
      if (k > 0) {
        go(Place::z, std::span(parts).subspan(2, 1), 0);
      }
    }
  });
}

void Transport::columns(Wind& wind, std::span<Field* const> scalars, std::size_t conserved,
                        bool backwards) {
  const Field& mass = backwards ? rest_ : second_;
  const auto rest = backwards ? std::span<const float>() : std::span<const float>(air_.cell);
  each(lattice_.ny, [&](Index j) {
    const std::array<Field*, 3> parts{&wind.u, &wind.v, &wind.w};
    const auto go = [&](Place place, std::span<Field* const> fields, std::size_t rescaled) {
      sweep_columns({lattice_, Axis::z, place, z_, mass, rest, fields, rescaled, sparse(place),
                     exchange(Axis::z), place == Place::middle ? scalar_mixing : 1.0F},
                    j);
    };
    go(Place::middle, scalars, conserved);
    go(Place::x, std::span(parts).subspan(0, 1), 0);
    if (j > 0) {
      go(Place::y, std::span(parts).subspan(1, 1), 0);
    }
    go(Place::z, std::span(parts).subspan(2, 1), 0);
  });
}

int Transport::advance(Wind& wind, std::span<Field* const> scalars, std::size_t unconserved,
                       double dt, bool backwards, std::span<BoundaryFlux> crossed,
                       const Field* mixing) {
  const int substeps = prepare(wind, dt, backwards);
  mixes_ = mixing != nullptr;
  if (mixing) {
    exchanges(*mixing, dt / substeps);
  }
  if (substeps >= most_substeps) {
    throw Error("the wind is too strong for the grid; use a shorter time step");
  }
  const std::size_t conserved = scalars.size() - unconserved;
  crossed_.assign(scalars.size() * static_cast<std::size_t>(lattice_.nz), {});
  for (int step = 0; step < substeps; ++step) {
    if (backwards) {
      columns(wind, scalars, conserved, backwards);
      levels(wind, scalars, conserved, backwards, crossed_);
    } else {
      levels(wind, scalars, conserved, backwards, crossed_);
      columns(wind, scalars, conserved, backwards);
    }
  }
  const double area = lattice_.spacing * lattice_.spacing;
  for (std::size_t i = 0; i < crossed_.size(); ++i) {
    crossed[i % scalars.size()].in += crossed_[i].in * area;
    crossed[i % scalars.size()].out += crossed_[i].out * area;
  }
  return substeps;
}

} // namespace firetwin::flow
