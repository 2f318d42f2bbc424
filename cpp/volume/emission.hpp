#pragma once

#include "volume/puffs.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace firetwin::volume {

constexpr std::size_t stem_count = 6; ///< parts of an interval that are tracked separately at first

/// Fuel that the cells of one block burn in one interval. Position, wind and powers describe the
/// full interval, including its future part, so that they do not depend on the time of the query.
struct Source {
  std::uint64_t key = 0;  ///< hash of block and interval
  std::uint64_t gust = 0; ///< hash shared by neighbours in space and time
  double start = 0.0;     ///< s
  std::array<double, 3> position{};
  std::array<double, 2> wind{};
  double power = 0.0;                     ///< W, mean over the interval
  double merged_power = 0.0;              ///< W, including the neighbourhood
  double burned = 0.0;                    ///< kg of fuel up to now
  std::array<double, stem_count> stems{}; ///< kg of fuel up to now, by part of the interval
};

struct Emission {
  std::vector<Source> sources;
  double burned = 0.0;    ///< kg of fuel up to now
  double forgotten = 0.0; ///< kg of it burned in intervals older than max_age
};

/// Groups burning cells into sources by block and interval.
Emission gather(double time, const Burn& burn, const PuffSettings& settings);

} // namespace firetwin::volume
