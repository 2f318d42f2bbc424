#pragma once

#include "run/run.hpp"

#include <vector>

namespace firetwin::flux {

/// [ny nx] kg/m2, surface and canopy fuel of each cell of the model grid: the mean of the fuel
/// cells in it. Empty where the run does not know it, so that cells burn which have none.
std::vector<double> fuel_of_cells(const run::Run& run);

/// [fy fx] surface and canopy fuel of the fuel cells, kg/m2, 0 where it is not known.
std::vector<float> fuel_load(const run::Run& run);

} // namespace firetwin::flux
