#pragma once

#include "grid.hpp"
#include "pressure.hpp"
#include "settings.hpp"

namespace flame_solver {

/// A buoyant diffusion flame in a box.
class Flame {
public:
  explicit Flame(const Settings& settings);

  /// Longest time step: 1.4 cells at the greatest speed, and the setting.
  [[nodiscard]] float longest_step() const;
  void advance(float duration);

  [[nodiscard]] const Grid& mixture() const { return mixture_; }
  [[nodiscard]] const Grid& temperature() const { return temperature_; }
  [[nodiscard]] const Velocity& flow() const { return flow_; }
  [[nodiscard]] const Grid& expansion() const { return expansion_; }
  [[nodiscard]] float time() const { return time_; }

private:
  void add_fuel(float duration);
  void hold_boundaries(float duration);

  Settings settings_;
  float cell_, time_ = 0.0F;
  Velocity flow_;
  Grid mixture_, temperature_, expansion_, fuel_;
  Pressure pressure_;
};

} // namespace flame_solver
