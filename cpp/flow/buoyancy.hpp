#pragma once

#include "flow/sides.hpp"

namespace firetwin::flow {

/// Weight of air against that of the ambient at the same height: up, and along the slope of a level
/// that follows the ground. The force is -b grad(height), with the height of the level's points, so
/// that it does no work around a closed path and air at rest, layered as the ambient is, stays at
/// rest over any ground. (That the levels are not at right angles is left out of the pressure:
/// errors go with the square of the slope.)
class Buoyancy {
public:
  Buoyancy(const Lattice& lattice, const Ground& ground, const Ambient& ambient);

  void push(State& state, double dt);

  /// Memory that is free between pushes.
  Field& scratch() { return force_; }

private:
  void weigh(const State& state, Index k);
  void lift(State& state, float dt, Index k) const;
  void along_slope(State& state, float dt, Index k) const;

  const Lattice& lattice_;
  const Ground& ground_;
  const Ambient& ambient_;
  Field force_; ///< m/s2
};

} // namespace firetwin::flow
