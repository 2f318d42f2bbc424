#pragma once

#include "flow/ambient.hpp"
#include "flow/buoyancy.hpp"
#include "flow/mixing.hpp"
#include "flow/nest.hpp"
#include "flow/pressure.hpp"
#include "flow/sides.hpp"
#include "flow/sources.hpp"
#include "flow/transport.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace firetwin::flow {

/// Where a flow is solved.
struct Box {
  Index nx;
  Index ny;
  double spacing;             ///< m
  std::vector<double> levels; ///< [nz + 1] heights above ground, m, from 0 up
  Corner corner{};            ///< of the lowest x and y, m
  std::vector<double> ground; ///< [ny][nx] height of cells' middles, m, or empty: flat
};

struct Settings {
  Edges edges;
  Gusts gusts;
  double mixing = 0.18;       ///< Smagorinsky's constant; 0: the advection's diffusion alone
  double source_depth = 90.0; ///< heat and smoke go in as exp(-height / depth), m
};

/// The smoke's account, kg: initial + emitted + entered + rounding = airborne + left.
struct Mass {
  double initial = 0.0;
  double emitted = 0.0;
  double entered = 0.0; ///< through the sides
  double left = 0.0;
  double airborne = 0.0;
  double rounding = 0.0; ///< what rounding added to the air
};

/// The heat's account, J. `held` is cp times the air's mass times its potential temperature above
/// the ambient's; in neutral air it equals `warmed` until the plume reaches the sides or the top.
struct Heat {
  double given = 0.0;  ///< by sources
  double warmed = 0.0; ///< the same over the Exner function where it was given
  double held = 0.0;
};

/// Smoke of a fire as a buoyant flow: the anelastic equations (Lipps and Hemler 1982, "A scale
/// analysis of deep moist convection", J. Atmos. Sci. 39) on a staggered grid that follows the
/// ground. Each step carries scalars and momentum (transport.hpp), adds heat and smoke, weighs
/// (buoyancy.hpp), draws the sides to what is around (sides.hpp), and balances (pressure.hpp).
///
/// Limits: sound is left out, and with it winds near its speed; eddies below the cells are the
/// advection's own diffusion; no rain, no ice, no radiation; levels follow the ground, but the
/// pressure takes them for even ones and every column for one of mean depth, which holds for slopes
/// well below 1 and relief well below the box's height.
class Solver {
public:
  Solver(Box box, Profile profile, const Settings& settings);

  /// A finer box inside this one. Its sides and beginning are this flow's; `outer` must live on.
  Solver(Box box, std::shared_ptr<const Solver> outer, const Settings& settings);

  /// What burns from now on.
  void set_sources(Sources sources);

  /// Changes the wind around; the flow within moves along with it.
  void set_wind(const std::vector<std::array<double, 2>>& wind);

  /// @throws Error when the flow has become infinite
  void step(double dt);

  double time() const { return time_; }
  std::int64_t steps() const { return steps_; }
  int substeps() const { return substeps_; }
  double courant() const { return transport_.courant(); }
  double divergence() const { return pressure_.divergence(state_.wind); }
  Mass mass() const;
  Heat heat() const;
  const Lattice& lattice() const { return lattice_; }
  const Ground& ground() const { return ground_; }
  const Ambient& ambient() const { return ambient_; }
  const Corner& corner() const { return corner_; }
  const State& state() const { return state_; }
  const Profile& profile() const { return profile_; }

  /// For going on from a state that was kept.
  struct Account {
    double time = 0.0;
    std::int64_t steps = 0;
    Mass mass;
    Heat heat;
  };
  Account account() const;
  State& open() { return state_; }
  void resume(const Account& account, const std::vector<std::array<double, 2>>& wind);
  void close() { sides_.close(state_, outside_.get()); } ///< ghost cells of a state that was put in

private:
  Solver(Box box, Profile profile, const Settings& settings, std::shared_ptr<const Solver> outer);
  void start();
  void follow(double dt);
  void carry(double dt);
  void burn(double dt);
  void settle();
  void add_to_level(const Deposit& deposit, double dt, Index k);
  double airborne() const;

  Lattice lattice_;
  Corner corner_;
  Profile profile_;
  Settings settings_;
  std::shared_ptr<const Solver> outer_;
  Ground ground_;
  Ambient ambient_;
  State state_;
  Transport transport_;
  Pressure pressure_;
  Mixing mixing_;
  Buoyancy buoyancy_;
  Sides sides_;
  std::vector<double> shares_;
  Sources sources_;
  std::optional<Window> window_;
  std::unique_ptr<State> outside_,
      coming_;             ///< of a nest: the flow around, now and when `outer_` is
  std::int64_t seen_ = -1; ///< step of `outer_` that `coming_` is
  double time_ = 0.0;
  std::int64_t steps_ = 0;
  int substeps_ = 0;
  Mass mass_;
  Heat heat_;
};

} // namespace firetwin::flow
