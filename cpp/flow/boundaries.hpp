#pragma once

#include "flow/ambient.hpp"

#include <vector>

namespace firetwin::flow {

/// Prognostic variables of the flow.
struct State {
  State(const Lattice& lattice, bool moist)
      : wind(lattice), theta(lattice, lattice.nz), smoke(lattice, lattice.nz),
        age(lattice, lattice.nz), water(lattice, moist ? lattice.nz : 0) {}
  Wind wind;
  Field theta; ///< liquid water potential temperature minus Ambient::reference(), K; conserved in
               ///< condensation
  Field smoke; ///< smoke mixing ratio, kg/kg
  Field age;   ///< smoke mixing ratio times age, kg/kg s
  Field water; ///< total water mixing ratio (vapour and cloud), kg/kg
};

/// Relaxation zone: a lateral sponge layer, Rayleigh damping below the top, and surface drag, all
/// towards the ambient air.
struct RelaxationZone {
  double width = 8.0;          ///< lateral sponge layer, cells; quadratic weight
  double time = 40.0;          ///< relaxation time at the lateral boundaries, s
  double damping_share = 0.22; ///< share of the domain's height with Rayleigh damping, 0 to 1
  double damping_time = 60.0;  ///< relaxation time at the top, s
  double drag_time = 300.0;    ///< relaxation time of the lowest level's wind, s
};

/// Lateral and upper boundary conditions. Relaxes the flow to the ambient air, fills ghost cells
/// and sets the wind through the lateral faces. Smoke is not relaxed: it leaves with the wind.
class Boundaries {
public:
  Boundaries(const Lattice& lattice, const Ambient& ambient, const RelaxationZone& zone);

  /// Applies sponge layer, Rayleigh damping and surface drag over a step of dt seconds to level k.
  /// @param outside outer flow on this lattice, near the boundaries; null: the ambient air
  void relax(State& state, const State* outside, double dt, Index k) const;

  /// Fills ghost cells of level k and sets its wind through the lateral faces.
  void fill_ghost_cells(State& state, const State* outside, Index k) const;

  /// Closes the ground and the top, and balances inflow and outflow through the lateral faces.
  void close(Wind& wind) const;

  /// Width, in columns, of the boundary zone that `outside` must cover.
  Index reach() const { return reach_; }

private:
  void relax_level(State& state, const State* outside, double dt, Index k) const;
  void relax_top(State& state, double dt, Index k) const;
  void balance(Wind& wind) const;

  const Lattice& lattice_;
  const Ambient& ambient_;
  RelaxationZone zone_;
  Index reach_;
  std::vector<float> x_, y_;           ///< sponge weights at cell centres
  std::vector<float> x_face_, y_face_; ///< sponge weights at faces
};

} // namespace firetwin::flow
