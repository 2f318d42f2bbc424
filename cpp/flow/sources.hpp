#pragma once

#include "flow/ambient.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace firetwin::flow {

/// What burns: n places on the ground.
struct Sources {
  std::vector<std::array<double, 2>> position; ///< m
  std::vector<double> heat;                    ///< that goes into the air, W
  std::vector<double> smoke;                   ///< kg/s
  std::vector<double> water;                   ///< vapour, kg/s, or empty
};

/// A fire flickers: its heat and smoke are shared out unevenly, and their sums stay. A lognormal
/// factor that is alike within `size` m and `time` s; it depends on seed, place and time alone.
struct Gusts {
  double strength = 0.0; ///< standard deviation of the factor's logarithm
  double size = 400.0;
  double time = 90.0;
  std::uint64_t seed = 0;
};

/// exp(strength g - strength^2 / 2), g normal.
double gust(const Gusts& gusts, double x, double y, double time);

/// What columns of air get, per second.
struct Deposit {
  std::vector<double> heat;  ///< [ny][nx] W
  std::vector<double> smoke; ///< kg/s
  std::vector<double> water; ///< kg/s
};

/// Each source to the four nearest columns, bilinearly. Sources that are not all inside the box are
/// left out.
Deposit deposit(const Sources& sources, const Lattice& lattice, const std::array<double, 2>& origin,
                const Gusts& gusts, double time);

/// Share of a column's heat and smoke that each level gets: exp(-z' / depth), summing to 1.
std::vector<double> shares(const Lattice& lattice, double depth);

} // namespace firetwin::flow
