#pragma once

#include "base/simd.hpp"

#include <cstddef>

/// SIMD vectors of fixed width.
namespace firetwin::volume {

constexpr std::size_t lane_count = 8;
using Lanes = Simd<float, lane_count>;
using WideLanes = Simd<double, 4>;

} // namespace firetwin::volume
