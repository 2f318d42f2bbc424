#pragma once

#include "grid.hpp"

namespace flame_solver {

/// Carries mixture fraction and temperature along the flow over a time of `step` times a cell.
void carry_scalars(Grid& mixture, Grid& temperature, const Velocity& flow, float step);

/// Carries the velocity along itself.
void carry_velocity(Velocity& flow, float step);

} // namespace flame_solver
