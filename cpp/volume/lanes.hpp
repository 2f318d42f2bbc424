#pragma once

#include <cstddef>

/// Vectors of numbers that processors work on at once.
namespace firetwin::volume {

constexpr std::size_t lane_count = 8;
using Lanes = float __attribute__((vector_size(lane_count * sizeof(float))));
using WideLanes = double __attribute__((vector_size(4 * sizeof(double))));

} // namespace firetwin::volume
