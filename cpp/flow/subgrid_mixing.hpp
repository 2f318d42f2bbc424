#pragma once

#include "flow/boundaries.hpp"

namespace firetwin::flow {

/// Smagorinsky subgrid mixing: eddy viscosity K = (c d)^2 sqrt(|S|^2 - 3 N^2), with the shear S of
/// the wind's difference from the ambient wind, the buoyancy frequency N and the cube root d of a
/// cell's volume (Smagorinsky 1963, "General circulation experiments with the primitive equations",
/// Mon. Weather Rev. 91; stratification after Lilly 1962, "On the numerical simulation of buoyant
/// convection", Tellus 14). Momentum is diffused with K, scalars with `scalar_mixing` K.
class SubgridMixing {
public:
  SubgridMixing(const Lattice& lattice, const Ambient& ambient, double strength);

  bool on() const { return strength_ > 0.0; }

  /// Computes the eddy viscosity K of all cells, m2/s.
  void strengths(const State& state, Field& k) const;

private:
  void level(const State& state, Index k, Field& out) const;

  const Lattice& lattice_;
  const Ambient& ambient_;
  double strength_;
};

} // namespace firetwin::flow
