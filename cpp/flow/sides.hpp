#pragma once

#include "flow/ambient.hpp"

#include <vector>

namespace firetwin::flow {

/// All that flows. `theta` is K above the ambient's reference, were all cloud water vapour (liquid
/// water potential temperature: condensation leaves it alone); smoke and water kg per kg of air;
/// age is smoke x seconds.
struct State {
  State(const Lattice& lattice, bool moist)
      : wind(lattice), theta(lattice, lattice.nz), smoke(lattice, lattice.nz),
        age(lattice, lattice.nz), water(lattice, moist ? lattice.nz : 0) {}
  Wind wind;
  Field theta;
  Field smoke;
  Field age;
  Field water;
};

/// How the box's surroundings reach into it.
struct Edges {
  double width = 8.0;         ///< cells from each side, weight falling as a square
  double time = 40.0;         ///< at the sides, s
  double top = 0.22;          ///< share of the height that is damped
  double top_time = 60.0;     ///< s
  double ground_time = 300.0; ///< drag: the lowest level returns to the ambient wind, s
};

/// Draws a flow to what is around it: near the sides, near the top and at the ground. Ghost cells
/// and the wind through the sides are what is outside. Smoke is left alone: it leaves with the
/// wind.
class Sides {
public:
  Sides(const Lattice& lattice, const Ambient& ambient, const Edges& edges);

  /// @param outside the flow around, on this lattice, near the sides; null: the ambient air
  void relax(State& state, const State* outside, double dt) const;

  /// Ghost cells, and the wind through the sides, which is balanced: as much in as out.
  void close(State& state, const State* outside) const;

  /// Of the cells that `outside` must hold: columns nearer to a side than this.
  Index reach() const { return reach_; }

private:
  void relax_level(State& state, const State* outside, double dt, Index k) const;
  void relax_top(State& state, double dt, Index k) const;
  void balance(Wind& wind) const;

  const Lattice& lattice_;
  const Ambient& ambient_;
  Edges edges_;
  Index reach_;
  std::vector<float> x_, y_;           ///< weights of cells' middles
  std::vector<float> x_face_, y_face_; ///< and of faces
};

} // namespace firetwin::flow
