#pragma once

#include "lod/sight.hpp"

#include <span>

namespace firetwin::lod {

/// Which of n balls count for a sight. Squares of ground with all that stands in them are asked
/// first, so that what is far from any view costs next to nothing.
/// @param centre [3 n] m
/// @param radius [n] m
/// @param out [n]
/// @throws std::invalid_argument for negative radii, reaches or margins.
void seen(std::span<const double> centre, std::span<const double> radius, const Sight& sight,
          const Demand& demand, std::span<bool> out);

/// Least distance of each of n places from the cameras in perspective, m; infinite without any.
/// @param place [3 n] m
void distance(std::span<const double> place, const Sight& sight, std::span<double> out);

} // namespace firetwin::lod
