#pragma once

#include "grid.hpp"
#include "settings.hpp"

namespace flame_solver {

inline constexpr float fuel_mixture =
    5.0F; ///< mixture fraction of fuel gas, stoichiometric = 1 (by eye)

inline constexpr float bed_height = 0.06F; ///< units; height over which a bed's fuel thins by e

/// Fuel (nx, ny, nz) per cell, from 0 to 1: a crown is clumps within a spindle, a bed thins upwards
/// and is half gone where it burned.
Grid fuel_density(const Settings& settings);

/// Adds the gas of a line of fire: strongest at an uneven leading edge, in patches that change.
void add_line_fuel(Grid& mixture, const Settings& settings, float time, float duration);

/// Adds the gas of burning foliage, whose clumps flare up and die down.
void add_crown_fuel(Grid& mixture, const Grid& density, const Settings& settings, float time,
                    float duration);

} // namespace flame_solver
