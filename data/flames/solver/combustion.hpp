#pragma once

#include "grid.hpp"
#include "settings.hpp"

namespace flame_solver {

/// Mixes the mixture fraction by eddies below a cell: Smagorinsky's model for it alone, so that the
/// flow keeps its small eddies.
void mix(Grid& mixture, const Velocity& flow, float cell, float duration);

/// Sets the temperature (excess over the air's, relative to the air's) of an infinitely fast
/// reaction, and the expansion of the gas: its divergence times the edge of a cell.
void burn(const Grid& mixture, Grid& temperature, Grid& expansion, float cell, float duration);

} // namespace flame_solver
