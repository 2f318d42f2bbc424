#pragma once

#include "geo/height_field.hpp"
#include "particles/motion.hpp"

#include <cstdint>
#include <span>

namespace firetwin::particles {

/// n particles, updated in place.
struct Particles {
  std::span<double> position;     ///< [3 n] m
  std::span<double> velocity;     ///< [3 n] m/s
  std::span<std::uint8_t> landed; ///< [n] landed particles do not move
};

/// Forces on each particle during a step.
struct Forces {
  std::span<const double> wind;        ///< [3 n] at the beginning of the step, m/s
  std::span<const double> wind_middle; ///< [3 n] in its middle
  std::span<const double> wind_end;    ///< [3 n] at its end; it changes as a parabola through them
  std::span<const double> lift;        ///< [n] weight less buoyancy, upwards, m/s2
  std::span<const double> relaxation;  ///< [n] tau of the drag, s
};

/// Advances particles by one step with the exact solution of motion.hpp. A particle that reaches
/// the ground stays there with zero velocity. The result does not depend on the number of threads.
/// @param ground may be null
/// @throws std::invalid_argument unless step >= 0 is finite and no relaxation is negative or NaN
void advance(const Particles& particles, const Forces& forces, double step,
             const geo::HeightField* ground);

} // namespace firetwin::particles
