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

const Field& Transport::exchange(Axis axis) const {
  return axis == Axis::x ? mix_x_ : axis == Axis::y ? mix_y_ : mix_z_;
}

/// Computes eddy exchange across the faces of row j of level k along an axis. It is limited by the
/// air that is left where one direction has drained a cell.
void Transport::exchange_faces(Axis axis, const Field& mixing, double dt, Index k, Index j) {
  const auto at = static_cast<std::size_t>(k);
  const bool up = axis == Axis::z;
  const Index low_k = up ? k - 1 : k, low_j = axis == Axis::y ? j - 1 : j;
  const Index left = axis == Axis::x ? 1 : 0;
  const auto rows = [&](const Field& field) {
    return std::array{field.row(low_k, low_j) - left, field.row(k, j)};
  };
  const auto k_rows = rows(mixing), first = rows(first_), second = rows(second_);
  const double across = dt / (lattice_.spacing * lattice_.spacing);
  const float factor = up ? air_.face[at] * static_cast<float>(dt / lattice_.gap(k))
                          : air_.cell[at] * static_cast<float>(across);
  float* out = (axis == Axis::x ? mix_x_ : axis == Axis::y ? mix_y_ : mix_z_).row(k, j);
  exchange_row(lattice_.nx, k_rows, {first[0], first[1], second[0], second[1]}, factor, most_mixing,
               out);
  if (left > 0) {
    out[0] = 0.0F; // nothing passes the domain's faces
  }
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

/// Computes the fluxes of level k in a substep, the air of its cells after one direction and after
/// two, and the exchange across its vertical faces. @return the largest share of air that a cell
/// loses in one direction; after the last one, cells have the air at rest
double Transport::prepare_level(const Wind& wind, const Field* mixing, double dt, bool backwards,
                                Index k) {
  const Index nx = lattice_.nx, ny = lattice_.ny;
  const auto at = static_cast<std::size_t>(k);
  const auto vertical = [&](Index level) {
    return static_cast<float>(static_cast<double>(air_.face[static_cast<std::size_t>(level)]) * dt);
  };
  const float rest = air_.cell[at];
  const auto across = static_cast<float>(static_cast<double>(rest) * (dt / lattice_.spacing));
  const float up = vertical(k), top = vertical(k + 1);
  std::vector<float> above(static_cast<std::size_t>(lattice_.stride));
  KeptAir kept;
  kept.least_first.fill(rest);
  kept.least_second.fill(1.0F);
  kept.most_second.fill(rest);
  scale_row(nx, wind.v.row(k, 0), across, y_.row(k, 0));
  for (Index j = 0; j < ny; ++j) {
    scale_row(nx, wind.v.row(k, j + 1), across, y_.row(k, j + 1));
    scale_row(nx + 1, wind.u.row(k, j), across, x_.row(k, j));
    scale_row(nx, wind.w.row(k, j), up, z_.row(k, j));
    const float *in = x_.row(k, j), *out = in + 1;
    if (backwards) {
      scale_row(nx, wind.w.row(k + 1, j), top, above.data());
      in = z_.row(k, j);
      out = above.data();
    }
    drain_row(nx, {in, y_.row(k, j)}, {out, y_.row(k, j + 1)}, rest, first_.row(k, j),
              second_.row(k, j), kept);
    if (mixing) {
      exchange_faces(Axis::x, *mixing, dt, k, j);
    }
    if (mixing && j > 0) {
      exchange_faces(Axis::y, *mixing, dt, k, j);
    }
  }
  const float least =
      std::min(std::ranges::min(kept.least_first) / rest, std::ranges::min(kept.least_second));
  return 1.0 - static_cast<double>(std::min(least, rest / std::ranges::max(kept.most_second)));
}

int Transport::prepare(const Wind& wind, const Field* mixing, double dt, bool backwards) {
  courant_ = max_courant(wind, dt);
  int substeps = std::max(1, static_cast<int>(std::ceil(courant_ / most_courant)));
  const auto drained = [&] {
    return max_each(lattice_.nz, [&](Index k) {
      return prepare_level(wind, mixing, dt / substeps, backwards, k);
    });
  };
  while (drained() >= max_drained && substeps < most_substeps) {
    substeps *= 2;
  }
  if (mixing) {
    each(lattice_.nz - 1, [&](Index k) {
      for (Index j = 0; j < lattice_.ny; ++j) {
        exchange_faces(Axis::z, *mixing, dt / substeps, k + 1, j);
      }
    });
  }
  return substeps;
}

/// Returns the sweeps of all fields along an axis.
std::array<Sweep, 4> Transport::sweeps(Axis axis, const Field& mass, bool last,
                                       const Advected& fields) const {
  const auto sweep = [&](Place place, std::span<Field* const> moved, std::size_t rescaled,
                         std::size_t sparse, float mixing) {
    return Sweep{lattice_, axis,     place,  flux(axis),     mass,  air_.cell.data(),
                 moved,    rescaled, sparse, exchange(axis), mixing};
  };
  const auto momentum = [&](Place place, std::size_t part) {
    return sweep(place, std::span(fields.wind).subspan(part, 1), 0, 0, 1.0F);
  };
  return {sweep(Place::middle, fields.scalars, last ? fields.conserved : 0, 2, scalar_mixing),
          momentum(Place::x, 0), momentum(Place::y, 1), momentum(Place::z, 2)};
}

void Transport::levels(const Advected& fields, bool backwards, std::span<BoundaryFlux> crossed) {
  const auto first =
      backwards ? sweeps(Axis::y, first_, false, fields) : sweeps(Axis::x, rest_, false, fields);
  const auto second =
      backwards ? sweeps(Axis::x, second_, true, fields) : sweeps(Axis::y, first_, false, fields);
  const std::size_t count = fields.scalars.size();
  each(lattice_.nz, [&](Index k) {
    const auto part = crossed.subspan(static_cast<std::size_t>(k) * count, count);
    sweep_level(first, k, part);
    sweep_level(second, k, part);
  });
}

void Transport::columns(const Advected& fields, bool backwards) {
  const auto along = sweeps(Axis::z, backwards ? rest_ : second_, !backwards, fields);
  each(lattice_.ny, [&](Index j) { sweep_columns(along, j); });
}

int Transport::advance(Wind& wind, std::span<Field* const> scalars, std::size_t unconserved,
                       double dt, bool backwards, std::span<BoundaryFlux> crossed,
                       const Field* mixing) {
  const int substeps = prepare(wind, mixing, dt, backwards);
  if (substeps >= most_substeps) {
    throw Error("the wind is too strong for the grid; use a shorter time step");
  }
  const Advected fields{{&wind.u, &wind.v, &wind.w}, scalars, scalars.size() - unconserved};
  crossed_.assign(scalars.size() * static_cast<std::size_t>(lattice_.nz), {});
  for (int step = 0; step < substeps; ++step) {
    if (backwards) {
      columns(fields, backwards);
      levels(fields, backwards, crossed_);
    } else {
      levels(fields, backwards, crossed_);
      columns(fields, backwards);
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
