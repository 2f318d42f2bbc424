#pragma once

#include "flow/ambient.hpp"
#include "flow/boundaries.hpp"
#include "flow/buoyancy.hpp"
#include "flow/nest_interpolator.hpp"
#include "flow/pressure.hpp"
#include "flow/sources.hpp"
#include "flow/subgrid_mixing.hpp"
#include "flow/transport.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace firetwin::flow {

/// Computational domain: a terrain-following grid of square columns.
struct Domain {
  Index nx;
  Index ny;
  double spacing;             ///< side of a square cell, m
  std::vector<double> levels; ///< [nz + 1] heights of level faces above ground, m, from 0 up
  Corner corner{};            ///< south-west corner, m
  std::vector<double> ground; ///< [ny][nx] elevation of cell centres, m; empty: flat at 0
};

/// Settings of a Solver.
struct SolverSettings {
  RelaxationZone relaxation;
  Gusts gusts;
  double smagorinsky = 0.18;  ///< Smagorinsky constant; 0: only numerical diffusion
  double source_depth = 90.0; ///< e-folding height of heat and smoke sources, m
};

/// Default settings of a nest: a sponge layer of 10 cells with a relaxation time of 8 s.
SolverSettings nest_settings();

/// Smoke mass budget, kg: initial + emitted + entered + rounding = airborne + left.
struct MassBudget {
  double initial = 0.0;
  double emitted = 0.0;
  double entered = 0.0;  ///< through the lateral boundaries
  double left = 0.0;     ///< through the lateral boundaries
  double airborne = 0.0; ///< in the domain now
  double rounding = 0.0; ///< sum of rounding errors
};

/// Heat budget, J. In neutral air `held` equals `warmed` until the plume reaches a boundary.
struct HeatBudget {
  double given = 0.0;  ///< released by sources
  double warmed = 0.0; ///< `given` divided by the Exner function at the place of release
  double held = 0.0;   ///< cp x air mass x potential temperature excess over the ambient air
};

/// Anelastic flow solver for a buoyant smoke plume (Lipps and Hemler 1982, "A scale analysis of
/// deep moist convection", J. Atmos. Sci. 39). The grid is a terrain-following Arakawa C grid. A
/// step advects scalars and momentum (transport.hpp), adds heat and smoke (sources.hpp), adds
/// buoyancy (buoyancy.hpp), relaxes the boundary zone (boundaries.hpp) and projects the wind
/// (pressure.hpp).
///
/// Limits:
/// - The anelastic equations hold no sound waves, so winds must be well below the speed of sound.
/// - There is no rain, no ice and no radiation.
/// - The pressure solver assumes level layers and columns of mean depth. Slopes must be well below
///   1, and relief well below the domain's height.
class Solver {
public:
  Solver(Domain domain, Profile profile, const SolverSettings& settings);

  /// A nest: a finer domain inside of `outer`, one-way nested. It starts from the outer flow and
  /// takes its boundary values from it. The nest shares ownership of `outer`.
  Solver(Domain domain, const std::shared_ptr<const Solver>& outer, const SolverSettings& settings);

  /// Sets the fire's sources from now on.
  void set_sources(Sources sources);

  /// Changes the ambient wind, one vector (m/s) for each height of the profile. The change is added
  /// to the complete flow.
  void set_wind(const std::vector<std::array<double, 2>>& wind);

  /// Advances by dt seconds.
  /// @throws Error if the flow diverges to infinity
  void step(double dt);

  double time() const { return time_; } ///< model time since the start, s
  std::int64_t steps() const { return steps_; }
  int substeps() const { return substeps_; } ///< advection substeps of the last step
  /// Largest Courant number of the last step.
  double courant() const { return transport_.courant(); }
  /// Largest |div(rho u)| / rho, 1/s.
  double divergence() const { return pressure_.divergence(state_.wind); }
  MassBudget mass() const;
  HeatBudget heat() const;
  const Lattice& lattice() const { return lattice_; }
  const Terrain& ground() const { return ground_; }
  const Ambient& ambient() const { return ambient_; }
  const Corner& corner() const { return corner_; }
  const State& state() const { return state_; }
  const Profile& profile() const { return profile_; }

  /// Scalars of a checkpoint; with `state()` and the wind profile they restart the flow.
  struct Checkpoint {
    double time = 0.0;
    std::int64_t steps = 0;
    MassBudget mass;
    HeatBudget heat;
  };
  Checkpoint checkpoint() const;
  /// State to restore a checkpoint into; call `fill_ghost_cells()` afterwards.
  State& mutable_state() { return state_; }
  void restore(const Checkpoint& checkpoint, const std::vector<std::array<double, 2>>& wind);
  void fill_ghost_cells();

private:
  Solver(Domain domain, Profile profile, const SolverSettings& settings,
         std::shared_ptr<const Solver> outer);
  void initialize();
  void follow_outer(double dt);
  void carry(double dt);
  double add_sources(double dt);
  void accelerate(double dt);
  void add_to_level(const Deposit& deposit, double dt, Index k);
  double airborne(Index k) const;
  double airborne() const;

  Lattice lattice_;
  Corner corner_;
  Profile profile_;
  SolverSettings settings_;
  std::shared_ptr<const Solver> outer_;
  Terrain ground_;
  Ambient ambient_;
  State state_;
  Transport transport_;
  Pressure pressure_;
  SubgridMixing mixing_;
  Buoyancy buoyancy_;
  Boundaries boundaries_;
  std::vector<double> shares_;
  Sources sources_;
  std::optional<NestInterpolator> nest_interpolator_;
  std::unique_ptr<State> outside_,
      next_outer_;               ///< nest only: outer flow, interpolated to this lattice
  std::int64_t outer_step_ = -1; ///< step of `outer_` that `next_outer_` holds
  double time_ = 0.0;
  std::int64_t steps_ = 0;
  int substeps_ = 0;
  MassBudget mass_;
  HeatBudget heat_;
};

} // namespace firetwin::flow
