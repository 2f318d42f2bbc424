#pragma once

#include "flow/boundaries.hpp"

namespace firetwin::flow {

/// Buoyancy: acceleration by the virtual potential temperature excess over the ambient air, upwards
/// and along terrain-following levels. The force is -b grad(height), with the height of the level's
/// points, so it does no work along a closed path. Air at rest with the ambient stratification
/// stays at rest over any terrain. The pressure solver neglects that levels are not orthogonal; the
/// error grows with the square of the slope.
class Buoyancy {
public:
  Buoyancy(const Lattice& lattice, const Terrain& ground, const Ambient& ambient);

  void push(State& state, double dt);

  /// Scratch memory, unused between calls of `push`.
  Field& scratch() { return force_; }

private:
  void compute_force(const State& state, Index k);
  void lift(State& state, float dt, Index k) const;
  void along_slope(State& state, float dt, Index k) const;

  const Lattice& lattice_;
  const Terrain& ground_;
  const Ambient& ambient_;
  Field force_; ///< m/s2
};

} // namespace firetwin::flow
