#pragma once

#include "volume/puffs.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace firetwin::volume {

constexpr std::size_t stem_count =
    6; ///< parts of an interval that are followed one by one at first

/// What the cells of one block burn in one interval. The place, wind and powers belong to the whole
/// interval, also the part still to come, so they do not depend on the time of the query.
struct Source {
  std::uint64_t key = 0;  ///< of block and interval
  std::uint64_t gust = 0; ///< shared by neighbours in place and time
  double start = 0.0;     ///< s
  std::array<double, 3> position{};
  std::array<double, 2> wind{};
  double power = 0.0;                     ///< W, mean of the interval
  double merged_power = 0.0;              ///< W, with the neighbourhood's
  double burned = 0.0;                    ///< kg of fuel so far
  std::array<double, stem_count> stems{}; ///< kg of fuel so far in each part of the interval
};

struct Emission {
  std::vector<Source> sources;
  double burned = 0.0;    ///< kg of fuel up to now
  double forgotten = 0.0; ///< kg of it burned in intervals older than max_age
};

/// Gathers burning cells into sources: blocks x intervals.
Emission gather(double time, const Burn& burn, const PuffSettings& settings);

} // namespace firetwin::volume
