#pragma once

#include "grid.hpp"
#include "settings.hpp"

namespace flame_solver {

/// Speed of the wind at a height: a power law of exponent 0.3 (rough ground), `settings.wind` at
/// half a unit.
float wind_speed(const Settings& settings, float height);

/// Adds buoyancy, drag, gusts, small eddies and the confinement of vortices over a time.
void add_forces(Velocity& flow, const Grid& temperature, const Grid& fuel, const Settings& settings,
                float time, float duration);

} // namespace flame_solver
