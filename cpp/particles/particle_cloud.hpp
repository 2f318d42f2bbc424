#pragma once

#include "geo/height_field.hpp"
#include "particles/motion.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::particles {

using Range = std::array<double, 2>; ///< uniform between the two

/// Particle properties: embers or flame gas.
struct ParticleKind {
  double lift;      ///< weight less buoyancy, upwards, m/s2 (motion.hpp: lift)
  Range relaxation; ///< tau of the drag, s: terminal speed is |lift| tau
  Range rise;       ///< upward speed at launch, m/s
  Range spread;     ///< sideways speed at launch, m/s, in any direction
  Range life;       ///< lifetime, s
};

/// m sources that launch `rate` particles per second from `start` to `end`.
struct Sources {
  std::span<const double> position;  ///< [3 m] m
  std::span<const double> start;     ///< [m] s
  std::span<const double> end;       ///< [m] s
  std::span<const double> rate;      ///< [m] 1/s
  std::span<const std::uint64_t> id; ///< [m] key of the source's random numbers, such as its cell
  double size; ///< particles start in a square this wide about the position, m
};

/// Wind at ascending times, linear in between and constant outside.
struct Wind {
  std::span<const double> time;     ///< [k] s
  std::span<const double> velocity; ///< [k 3] m/s for all sources, or [k m 3] per source
};

/// n particles, ordered by source and number.
struct ParticleCloud {
  std::vector<std::int64_t> source; ///< index of the source
  std::vector<std::int64_t> number; ///< index of the particle within its source
  std::vector<double> position;     ///< [3 n] m
  std::vector<double> velocity;     ///< [3 n] m/s
  std::vector<double> age;          ///< s
  std::vector<double> life;         ///< s
  std::vector<std::uint8_t> landed;
};

/// Particles in the air or on the ground at one time, in closed form: particle k of a source starts
/// at start + (k + U) / rate, with random numbers of a Philox stream keyed by (seed, id, k), and
/// moves by the exact solution of motion.hpp. So frames can be computed in any order, and sources
/// are independent.
/// @param ground may be null; landed particles stay until the end of their life
/// @throws std::invalid_argument
ParticleCloud state(double time, const Sources& sources, const ParticleKind& kind, const Wind& wind,
                    const geo::HeightField* ground, std::uint64_t seed);

} // namespace firetwin::particles
