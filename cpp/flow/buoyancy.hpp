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

  /// Computes the force on level k.
  void compute_force(const State& state, Index k);

  /// Accelerates level k, after the forces on all levels are computed.
  void push(State& state, double dt, Index k) const;

  /// Scratch memory, unused from `push` to `compute_force`.
  Field& scratch() { return force_; }

private:
  const Lattice& lattice_;
  const Terrain& ground_;
  const Ambient& ambient_;
  Field force_;           ///< m/s2
  Field rise_x_, rise_y_; ///< [1][ny][nx] height of the ground above the cell before, m
};

} // namespace firetwin::flow
