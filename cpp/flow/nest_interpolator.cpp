#include "flow/nest_interpolator.hpp"

#include "base/interpolation.hpp"
#include "flow/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firetwin::flow {
namespace {

bool inside(double low, double high, double length) {
  return low >= 0.0 && high <= length;
}

/// Calls f(first, n) for the parts of row j within `reach` of a side, including ghost cells.
template <class Function>
void near_sides(const Lattice& l, Index j, Index reach, const Function& f) {
  const Index begin = -halo, end = l.nx + halo;
  if (j < reach || j >= l.ny - reach || 2 * reach >= l.nx) {
    f(begin, end - begin);
  } else {
    f(begin, reach - begin);
    f(l.nx - reach, end - (l.nx - reach));
  }
}

} // namespace

NestInterpolator::NestInterpolator(const Lattice& from, const Corner& from_corner,
                                   const Ambient& from_ambient, const Lattice& to,
                                   const Corner& to_corner, const Ambient& to_ambient)
    : from_(from), to_(to), offset_{to_corner[0] - from_corner[0], to_corner[1] - from_corner[1]},
      from_ambient_(from_ambient), to_ambient_(to_ambient) {
  const double margin = 2.0 * to.spacing;
  const auto length = [](Index n, double spacing) { return static_cast<double>(n) * spacing; };
  if (!inside(offset_[0] - margin, offset_[0] + length(to.nx, to.spacing) + margin,
              length(from.nx, from.spacing)) ||
      !inside(offset_[1] - margin, offset_[1] + length(to.ny, to.spacing) + margin,
              length(from.ny, from.spacing)) ||
      to.top() > from.top()) {
    throw std::invalid_argument("the nest must be inside of its outer domain");
  }
  middle_ = axes(Place::middle);
  u_ = axes(Place::x);
  v_ = axes(Place::y);
  w_ = axes(Place::z);
}

NestInterpolator::Axes NestInterpolator::axes(Place place) const {
  Axes result;
  const auto across = [&](Index count, double offset, bool face) {
    std::vector<Knot> knots;
    for (Index i = -halo; i < count + halo; ++i) {
      const double shift = face ? 0.0 : 0.5;
      const double at =
          (offset + (static_cast<double>(i) + shift) * to_.spacing) / from_.spacing - shift;
      const double low = std::floor(at);
      knots.push_back({static_cast<Index>(low), static_cast<float>(at - low)});
    }
    return knots;
  };
  result.x = across(to_.nx, offset_[0], place == Place::x);
  result.y = across(to_.ny, offset_[1], place == Place::y);
  const auto& have = place == Place::z ? from_.face : from_.middle;
  for (const double z : place == Place::z ? to_.face : to_.middle) {
    const auto above = std::upper_bound(have.begin() + 1, have.end() - 1, z);
    const auto low = static_cast<std::size_t>(above - have.begin()) - 1;
    const double part = (z - have[low]) / (have[low + 1] - have[low]);
    result.z.push_back({static_cast<Index>(low), static_cast<float>(std::clamp(part, 0.0, 1.0))});
  }
  return result;
}

void NestInterpolator::level(const Axes& axes, const Part& part, Index k, Index reach) const {
  const Knot z = axes.z[static_cast<std::size_t>(k)];
  for (Index j = -halo; j < to_.ny + halo; ++j) {
    const Knot y = axes.y[static_cast<std::size_t>(j + halo)];
    const auto value = [&](const Field& field, const Knot& x) {
      return trilinear([&](int up, int north,
                           int east) { return field.row(z.low + up, y.low + north)[x.low + east]; },
                       z.part, y.part, x.part);
    };
    near_sides(to_, j, reach, [&](Index first, Index n) {
      float* out = part.to->row(k, j);
      for (Index i = first; i < first + n; ++i) {
        const Knot& x = axes.x[static_cast<std::size_t>(i + halo)];
        const float here = value(*part.from, x);
        out[i] = part.from_rest ? part.to_rest->row(k, j)[i] + (here - value(*part.from_rest, x))
                                : here + part.constant;
      }
    });
  }
}

float NestInterpolator::wind_change(Index k, std::size_t axis) const {
  const Knot z = middle_.z[static_cast<std::size_t>(k)];
  const auto low = static_cast<std::size_t>(z.low);
  const auto& have = from_ambient_.wind();
  return to_ambient_.wind()[static_cast<std::size_t>(k)][axis] -
         lerp(have[low][axis], have[low + 1][axis], z.part);
}

void NestInterpolator::interpolate(const State& from, State& to, Index reach) const {
  each(to_.nz + 1, [&](Index k) {
    level(w_, {&from.wind.w, &to.wind.w}, k, reach);
    if (k == to_.nz) {
      return;
    }
    level(u_, {&from.wind.u, &to.wind.u, wind_change(k, 0)}, k, reach);
    level(v_, {&from.wind.v, &to.wind.v, wind_change(k, 1)}, k, reach);
    level(middle_, {&from.smoke, &to.smoke}, k, reach);
    level(middle_, {&from.age, &to.age}, k, reach);
    level(middle_, {&from.theta, &to.theta, 0.0F, &from_ambient_.theta(), &to_ambient_.theta()}, k,
          reach);
    if (to_ambient_.moist()) {
      level(middle_, {&from.water, &to.water, 0.0F, &from_ambient_.water(), &to_ambient_.water()},
            k, reach);
    }
  });
}

} // namespace firetwin::flow
