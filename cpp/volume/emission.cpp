#include "volume/emission.hpp"

#include "base/random.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace firetwin::volume {
namespace {

/// Returns the seconds of [low, high] during which a cell ignited at `arrival` burns.
double overlap(double arrival, double burn_time, double low, double high) {
  return std::max(0.0, std::min(high, arrival + burn_time) - std::max(low, arrival));
}

struct Block {
  std::uint64_t key;
  std::uint64_t neighbourhood;
  double phase; // s; offsets the intervals, so that blocks do not puff in phase
  std::vector<std::size_t> cells;
};

std::uint64_t block_key(double x, double y, double side, std::uint64_t seed) {
  const auto column = static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / side)));
  const auto row = static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(y / side)));
  return mix(mix(seed, column), row);
}

std::vector<Block> blocks(const Burn& burn, const PuffSettings& settings) {
  std::unordered_map<std::uint64_t, std::size_t> index;
  std::vector<Block> result;
  for (std::size_t cell = 0; cell < burn.arrival.size(); ++cell) {
    const double x = burn.position[3 * cell];
    const double y = burn.position[3 * cell + 1];
    const std::uint64_t key = block_key(x, y, settings.block, settings.seed);
    const auto [found, added] = index.try_emplace(key, result.size());
    if (added) {
      result.push_back({key,
                        block_key(x, y, 4.0 * settings.block, settings.seed),
                        uniform(key, 0) * settings.interval,
                        {}});
    }
    result[found->second].cells.push_back(cell);
  }
  return result;
}

/// Computes the source of `block` in interval `number`; `power` gets the fuel burned over the full
/// interval.
Source source(double time, const Burn& burn, const PuffSettings& settings, const Block& block,
              std::int64_t number) {
  Source result;
  const auto use = static_cast<std::uint64_t>(number);
  result.key = mix(block.key, use);
  result.start = block.phase + static_cast<double>(number) * settings.interval;
  const double end = result.start + settings.interval;
  const auto gust = static_cast<std::int64_t>(std::floor(result.start / (3.0 * settings.interval)));
  result.gust = mix(block.neighbourhood, static_cast<std::uint64_t>(gust));
  double whole = 0.0;
  for (const std::size_t cell : block.cells) {
    const double arrival = burn.arrival[cell];
    const double rate = burn.fuel[cell] * burn.cell_area / settings.burn_time; // kg/s
    const double all = rate * overlap(arrival, settings.burn_time, result.start, end);
    if (all <= 0.0) {
      continue;
    }
    whole += all;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result.position[axis] += all * burn.position[3 * cell + axis];
    }
    for (std::size_t axis = 0; axis < 2; ++axis) {
      result.wind[axis] += all * burn.wind[2 * cell + axis];
    }
    const double step = settings.interval / static_cast<double>(stem_count);
    for (std::size_t i = 0; i < stem_count; ++i) {
      const double low = result.start + static_cast<double>(i) * step;
      result.stems[i] +=
          rate * overlap(arrival, settings.burn_time, low, std::min(low + step, time));
    }
    result.burned += rate * overlap(arrival, settings.burn_time, result.start, std::min(end, time));
  }
  if (whole > 0.0) {
    for (double& value : result.position) {
      value /= whole;
    }
    for (double& value : result.wind) {
      value /= whole;
    }
  }
  result.power = whole * settings.heat_of_combustion / settings.interval;
  return result;
}

/// Sets merged_power of sources [first, last), which burn in the same interval.
void merge(std::span<Source> sources, double radius) {
  tbb::parallel_for(std::size_t{0}, sources.size(), [&](std::size_t i) {
    double sum = 0.0;
    for (const Source& other : sources) {
      const double x = (other.position[0] - sources[i].position[0]) / radius;
      const double y = (other.position[1] - sources[i].position[1]) / radius;
      sum += other.power * std::exp(-(x * x + y * y));
    }
    sources[i].merged_power = sum;
  });
}

} // namespace

Emission gather(double time, const Burn& burn, const PuffSettings& settings) {
  Emission result;
  const std::vector<Block> all = blocks(burn, settings);
  const double oldest = time - settings.max_age;
  for (const Block& block : all) {
    const double horizon =
        block.phase + std::ceil((oldest - block.phase) / settings.interval) * settings.interval;
    for (const std::size_t cell : block.cells) {
      const double rate = burn.fuel[cell] * burn.cell_area / settings.burn_time;
      result.burned +=
          rate * overlap(burn.arrival[cell], settings.burn_time, burn.arrival[cell], time);
      result.forgotten += rate * overlap(burn.arrival[cell], settings.burn_time, burn.arrival[cell],
                                         std::min(horizon, time));
    }
  }
  // The last interval of a phase-shifted block starts at `time` or earlier.
  const auto last = static_cast<std::int64_t>(std::floor(time / settings.interval));
  const auto first = static_cast<std::int64_t>(std::floor(oldest / settings.interval)) - 1;
  for (std::int64_t number = first; number <= last; ++number) {
    std::vector<Source> now(all.size());
    tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
      const double start = all[i].phase + static_cast<double>(number) * settings.interval;
      if (start >= oldest && start < time) {
        now[i] = source(time, burn, settings, all[i], number);
      }
    });
    std::erase_if(now, [](const Source& one) { return one.power <= 0.0; });
    merge(now, settings.merge_radius);
    result.sources.insert(result.sources.end(), now.begin(), now.end());
  }
  return result;
}

} // namespace firetwin::volume
