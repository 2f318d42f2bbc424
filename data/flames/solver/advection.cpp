#include "advection.hpp"

#include <span>

namespace flame_solver {
namespace {

using Vector = std::array<float, 3>;

Vector at_cell(const Velocity& f, int i, int j, int k) {
  const int q = after(j, f.v.ny);
  return {0.5F * (f.u(i, j, k) + f.u(i + 1, j, k)), 0.5F * (f.v(i, j, k) + f.v(i, q, k)),
          0.5F * (f.w(i, j, k) + f.w(i, j, k + 1))};
}

Vector at_u(const Velocity& f, int i, int j, int k) {
  const int q = after(j, f.v.ny), a = std::max(i - 1, 0), b = std::min(i, f.v.nx - 1);
  return {f.u(i, j, k), 0.25F * (f.v(a, j, k) + f.v(a, q, k) + f.v(b, j, k) + f.v(b, q, k)),
          0.25F * (f.w(a, j, k) + f.w(a, j, k + 1) + f.w(b, j, k) + f.w(b, j, k + 1))};
}

Vector at_v(const Velocity& f, int i, int j, int k) {
  const int m = before(j, f.v.ny);
  return {0.25F * (f.u(i, m, k) + f.u(i + 1, m, k) + f.u(i, j, k) + f.u(i + 1, j, k)), f.v(i, j, k),
          0.25F * (f.w(i, m, k) + f.w(i, m, k + 1) + f.w(i, j, k) + f.w(i, j, k + 1))};
}

Vector at_w(const Velocity& f, int i, int j, int k) {
  const int q = after(j, f.v.ny), a = std::max(k - 1, 0), b = std::min(k, f.v.nz - 1);
  return {0.25F * (f.u(i, j, a) + f.u(i + 1, j, a) + f.u(i, j, b) + f.u(i + 1, j, b)),
          0.25F * (f.v(i, j, a) + f.v(i, q, a) + f.v(i, j, b) + f.v(i, q, b)), f.w(i, j, k)};
}

/// Result of MacCormack's method at a place, limited to the values around its origin.
enum class Limit {
  clamp, ///< to the nearest of them; sharp
  revert ///< to the first-order value; leaves no lines along the grid on dissolving flames
};

float limited(float first, float corrected, const Corners& origin, const std::vector<float>& values,
              Limit limit) {
  float low = values[origin.at[0]], high = low;
  for (std::size_t n = 1; n < 8; ++n) {
    low = std::min(low, values[origin.at[n]]);
    high = std::max(high, values[origin.at[n]]);
  }
  if (limit == Limit::clamp) {
    return std::clamp(corrected, low, high);
  }
  return corrected < low || corrected > high ? first : corrected;
}

/// MacCormack's method (Selle et al. 2008) for fields that share a lattice.
template <class VelocityAt>
void carry(std::span<Grid* const> fields, const VelocityAt& velocity, float step, Limit limit) {
  const Grid& lattice = *fields[0];
  std::vector<Vector> way(lattice.values.size());
  std::vector<std::vector<float>> first(fields.size(), std::vector<float>(way.size()));
  for_each(lattice, [&](int i, int j, int k) {
    const std::size_t n = lattice.index(i, j, k);
    const Vector v = velocity(i, j, k);
    way[n] = {v[0] * step, v[1] * step, v[2] * step};
    const Corners origin =
        corners(lattice, static_cast<float>(i) - way[n][0], static_cast<float>(j) - way[n][1],
                static_cast<float>(k) - way[n][2]);
    for (std::size_t f = 0; f < fields.size(); ++f) {
      first[f][n] = origin.mean(fields[f]->values);
    }
  });
  std::vector<std::vector<float>> result = first;
  for_each(lattice, [&](int i, int j, int k) {
    if (i == 0 || i == lattice.nx - 1 || k == 0 || k == lattice.nz - 1) {
      return;
    }
    const std::size_t n = lattice.index(i, j, k);
    const auto x = static_cast<float>(i), y = static_cast<float>(j), z = static_cast<float>(k);
    const auto [a, b, c] = way[n];
    const Corners forth = corners(lattice, x + a, y + b, z + c);
    const Corners origin = corners(lattice, x - a, y - b, z - c);
    for (std::size_t f = 0; f < fields.size(); ++f) {
      const std::vector<float>& values = fields[f]->values;
      const float corrected = first[f][n] + 0.5F * (values[n] - forth.mean(first[f]));
      result[f][n] = limited(first[f][n], corrected, origin, values, limit);
    }
  });
  for (std::size_t f = 0; f < fields.size(); ++f) {
    fields[f]->values.swap(result[f]);
  }
}

} // namespace

void carry_scalars(Grid& mixture, Grid& temperature, const Velocity& flow, float step) {
  const std::array<Grid*, 2> fields{&mixture, &temperature};
  carry(fields, [&](int i, int j, int k) { return at_cell(flow, i, j, k); }, step, Limit::revert);
}

void carry_velocity(Velocity& flow, float step) {
  const Velocity old = flow;
  const std::array<Grid*, 1> u{&flow.u}, v{&flow.v}, w{&flow.w};
  carry(u, [&](int i, int j, int k) { return at_u(old, i, j, k); }, step, Limit::clamp);
  carry(v, [&](int i, int j, int k) { return at_v(old, i, j, k); }, step, Limit::clamp);
  carry(w, [&](int i, int j, int k) { return at_w(old, i, j, k); }, step, Limit::clamp);
}

} // namespace flame_solver
