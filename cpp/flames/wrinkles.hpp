#pragma once

#include "base/simd.hpp"

namespace firetwin::flames {

/// Displacement of gas by eddies of a few cells, which the solved fires do not hold: fractal noise
/// with a period of 16 cells, whose gradients are as steep at each of its scales.
/// @param x, y, z places, cells; displaced afterwards
/// @param strength factor on the displacement
void wrinkle(Lanes& x, Lanes& y, Lanes& z, const Lanes& strength);

} // namespace firetwin::flames
