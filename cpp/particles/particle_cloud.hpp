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
  Range life;       ///< s, after which a particle is gone
};

/// m places that launch `rate` particles a second from `start` to `end`.
struct Sources {
  std::span<const double> position;  ///< [3 m] m
  std::span<const double> start;     ///< [m] s
  std::span<const double> end;       ///< [m] s
  std::span<const double> rate;      ///< [m] 1/s
  std::span<const std::uint64_t> id; ///< [m] key of their random numbers, such as the cell
  double size; ///< particles start in a square this wide about the position, m
};

/// Wind at `time` (ascending), linear between, constant before and after.
struct Wind {
  std::span<const double> time;     ///< [k] s
  std::span<const double> velocity; ///< [k 3] m/s for all, or [k m 3] for each source
};

/// n particles, in order of source and number.
struct ParticleCloud {
  std::vector<std::int64_t> source; ///< index of the source
  std::vector<std::int64_t> number; ///< how many its source launched before
  std::vector<double> position;     ///< [3 n] m
  std::vector<double> velocity;     ///< [3 n] m/s
  std::vector<double> age;          ///< s
  std::vector<double> life;         ///< s
  std::vector<std::uint8_t> landed;
};

/// The particles that are in the air or on the ground at one time. It needs no time before it: how
/// particle k of a source starts follows from Philox keyed by (seed, id, k), its launch at
/// start + (k + U) / rate, and its path from motion.hpp's exact solution. So a frame comes out the
/// same in any order of calls, and no source changes another's particles.
/// @param ground may be null; particles that meet it lie there until their life ends
/// @throws std::invalid_argument
ParticleCloud state(double time, const Sources& sources, const ParticleKind& kind, const Wind& wind,
                    const geo::HeightField* ground, std::uint64_t seed);

} // namespace firetwin::particles
