#pragma once

#include "grid.hpp"

namespace flame_solver {

/// Damps waves of two cells, which advection leaves, by a fourth difference along each axis.
void damp_grid_waves(Grid& grid);

} // namespace flame_solver
