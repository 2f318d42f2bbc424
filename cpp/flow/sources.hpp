#pragma once

#include "flow/ambient.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace firetwin::flow {

/// Heat and smoke sources of a fire: n points on the ground.
struct Sources {
  std::vector<std::array<double, 2>> position; ///< m
  std::vector<double> heat;                    ///< convective heat, W
  std::vector<double> smoke;                   ///< kg/s
  std::vector<double> water;                   ///< vapour, kg/s; empty: none
};

/// Gusts: a lognormal factor on the sources with a correlation length `size` (m) and time `time`
/// (s). Sums of heat and smoke are conserved. The factor depends only on seed, place and time.
struct Gusts {
  double strength = 0.0; ///< standard deviation of the factor's logarithm
  double size = 400.0;
  double time = 90.0;
  std::uint64_t seed = 0;
};

/// Returns the lognormal factor exp(strength g - strength^2 / 2), g standard normal.
double gust(const Gusts& gusts, double x, double y, double time);

/// Source rates by column.
struct Deposit {
  std::vector<double> heat;  ///< [ny][nx] W
  std::vector<double> smoke; ///< kg/s
  std::vector<double> water; ///< kg/s
};

/// Distributes each source bilinearly to the four nearest columns. Sources outside of the outermost
/// cell centres are ignored.
Deposit deposit(const Sources& sources, const Lattice& lattice, const std::array<double, 2>& origin,
                const Gusts& gusts, double time);

/// Computes the vertical distribution of sources: exp(-z' / depth), normalised to the sum 1.
std::vector<double> shares(const Lattice& lattice, double depth);

} // namespace firetwin::flow
