#pragma once

#include "run/run.hpp"

#include <vector>

namespace firetwin::flux {

/// Surface and canopy fuel [ny nx] of the model grid, kg/m2: the mean over the fuel cells in each
/// cell. Empty if cells without fuel burn, because the run's fuel is incomplete.
std::vector<double> fuel_of_cells(const run::Run& run);

/// Surface and canopy fuel [fy fx] of the fuel cells, kg/m2; 0 if unknown.
std::vector<float> fuel_load(const run::Run& run);

} // namespace firetwin::flux
