#pragma once

#include "flow/sides.hpp"

namespace firetwin::flow {

/// What eddies smaller than the cells mix: a diffusion with K = (c d)^2 sqrt(|S|^2 - 3 N^2), of the
/// layering N and the shear S of what the wind differs from the ambient wind by, d the cube root of
/// a cell's volume (Smagorinsky 1963, "General circulation experiments with the primitive
/// equations", Mon. Weather Rev. 91; with the layering after Lilly 1962, "On the numerical
/// simulation of buoyant convection", Tellus 14). Momentum is diffused with K, part by part;
/// scalars with `scalar_mixing` K.
class Mixing {
public:
  Mixing(const Lattice& lattice, const Ambient& ambient, double strength);

  bool on() const { return strength_ > 0.0; }

  /// Fills K of cells, m2/s.
  void strengths(const State& state, Field& k) const;

private:
  void level(const State& state, Index k, Field& out) const;

  const Lattice& lattice_;
  const Ambient& ambient_;
  double strength_;
};

} // namespace firetwin::flow
