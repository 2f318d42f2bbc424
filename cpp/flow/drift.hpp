#pragma once

#include "flow/filters.hpp"
#include "flow/solver.hpp"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace firetwin::flow {

/// How far the air in each cell has come since its phase began: noise at (place - drift) travels
/// with the flow. Flow shears noise into streaks in the end, so a phase begins anew every `period`,
/// and two of them, half a period apart, take turns (Neyret 2003, "Advected textures").
///
/// Carried semi-Lagrangian (midpoint) at the middles of every other cell, linear between: what that
/// blurs is below the size at which drift is used. East, north and up along the levels, m.
class Drift {
public:
  static constexpr int phases = 2;
  static constexpr int parts = 3 * phases;

  Drift(std::shared_ptr<const Solver> solver, double period);

  /// Goes on to the solver's time, with the wind that it has now.
  void advance();

  /// How much a phase shows: none where it begins and ends; squares add up to 1.
  std::array<float, phases> weights() const;
  /// How often each phase has begun: its noise is another one each time.
  std::array<std::int64_t, phases> turns() const { return turns_; }
  double time() const { return time_; }
  /// Every other cell's levels, rows and columns.
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
  std::vector<double> middle_; ///< [levels] m above ground
  double period_;
  double time_;
  std::array<std::int64_t, phases> turns_;
  std::vector<float> speed_; ///< [levels][rows][columns][3] points/s
  std::vector<float> values_, next_;
};

} // namespace firetwin::flow
