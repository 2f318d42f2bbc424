#pragma once

#include "base/random.hpp"
#include "geo/local_frame.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace firetwin::forest {

/// Fuel grid on which plants are placed.
struct PlantingSite {
  std::span<const double> latitude;  ///< [fy] degrees
  std::span<const double> longitude; ///< [fx] degrees
  std::span<const float> elevation;  ///< [fy fx] m
  const geo::LocalFrame* frame;
  std::uint64_t seed;
  double jitter;              ///< 0: at cell centres, 1: anywhere in the cell
  std::span<const bool> mask; ///< [fy fx] cells with plants; empty: all
};

/// Independent random streams of a cell; the stream is part of the generator's counter.
enum class RandomStream : std::uint64_t { place = 0, tree = 1, grass = 2 };

/// Draws four uniform numbers in [0, 1) for a cell and a stream (Philox).
inline std::array<double, 4> draw(const PlantingSite& site, std::size_t cell, RandomStream use) {
  const auto bits = philox({cell, static_cast<std::uint64_t>(use), 0, 0}, {site.seed, 0});
  return {unit(bits[0]), unit(bits[1]), unit(bits[2]), unit(bits[3])};
}

} // namespace firetwin::forest
