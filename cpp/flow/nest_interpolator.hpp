#pragma once

#include "flow/boundaries.hpp"

namespace firetwin::flow {

/// South-west corner of a lattice, m.
using Corner = std::array<double, 2>;

/// Interpolation of an outer flow to the lattice of its nest: trilinear in x, y and height above
/// ground. It interpolates the difference from the ambient air, so air at rest stays at rest over
/// more detailed terrain.
class NestInterpolator {
public:
  NestInterpolator(const Lattice& from, const Corner& from_corner, const Ambient& from_ambient,
                   const Lattice& to, const Corner& to_corner, const Ambient& to_ambient);

  /// Fills `to`, including ghost cells, in columns within `reach` cells of a lateral boundary.
  void interpolate(const State& from, State& to, Index reach) const;

private:
  struct Knot {
    Index low;
    float part; ///< weight of low + 1
  };
  struct Axes {
    std::vector<Knot> x, y, z;
  };

  /// A field, and its values at rest on both lattices (fields, or a constant).
  struct Part {
    const Field* from;
    Field* to;
    float constant = 0.0F;
    const Field* from_rest = nullptr;
    const Field* to_rest = nullptr;
  };

  Axes axes(Place place) const;
  void level(const Axes& axes, const Part& part, Index k, Index reach) const;
  float wind_change(Index k, std::size_t axis) const;

  const Lattice& from_;
  const Lattice& to_;
  Corner offset_; ///< corner of the finer lattice in the coarser one, m
  const Ambient& from_ambient_;
  const Ambient& to_ambient_;
  Axes middle_, u_, v_, w_;
};

} // namespace firetwin::flow
