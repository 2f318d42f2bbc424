#pragma once

#include "flow/filters.hpp"
#include "flow/solver.hpp"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace firetwin::flow {

/// Advected texture coordinates (Neyret 2003, "Advected textures"): displacement of the air since
/// the start of a phase. Noise at (place - drift) travels with the flow. Shear stretches noise into
/// streaks, so each phase restarts every `period`. Two phases, half a period apart, are blended.
///
/// Advection is semi-Lagrangian (midpoint rule) at the centres of every other cell, linear in
/// between. Its numerical diffusion is below the scale at which drift is used. Components are east,
/// north and up along the levels, m.
class Drift {
public:
  static constexpr int phases = 2;
  static constexpr int parts = 3 * phases;

  Drift(std::shared_ptr<const Solver> solver, double period);

  /// Advects up to the solver's time with its present wind.
  void advance();

  /// Blend weight of each phase, 0 at its start and end; the squares sum to 1.
  std::array<float, phases> weights() const;
  /// Number of restarts of each phase; each restart changes the noise's seed.
  std::array<std::int64_t, phases> turns() const { return turns_; }
  double time() const { return time_; }
  /// Number of levels, rows and columns, at every other cell.
  Shape shape() const { return shape_; }
  /// [levels][rows][columns][phase][3], m
  std::span<const float> values() const { return values_; }
  void restore(double time, std::span<const float> values);

private:
  std::array<std::int64_t, phases> turns_at(double time) const;
  void find_speed();
  float height(float level) const;
  void carry(double dt, Index k);

  std::shared_ptr<const Solver> solver_;
  Shape shape_;
  std::vector<double> middle_; ///< [levels] cell centres, m above ground
  double period_;
  double time_;
  std::array<std::int64_t, phases> turns_;
  std::vector<float> speed_; ///< [levels][rows][columns][3] points/s
  std::vector<float> values_, next_;
};

} // namespace firetwin::flow
