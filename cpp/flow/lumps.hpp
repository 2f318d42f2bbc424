#pragma once

#include "flow/drift.hpp"
#include "flow/noise.hpp"

#include <array>
#include <cstdint>

namespace firetwin::flow {

/// Places that smoke came from, m: east, north and up.
using Origins = std::array<std::array<double, static_cast<std::size_t>(lanes)>, 3>;

/// Octaves of noise: Worley's lumps where smoke is vigorous, Perlin's veils where it is not.
class Lumps {
public:
  /// The largest and the finest, m; and what each phase's noise is known by.
  Lumps(double size, double finest, const std::array<std::uint32_t, Drift::phases>& seeds);

  /// Noise of a phase, for `vigour` from 0 to 1.
  void at(const Origins& places, std::size_t phase, const Row& vigour, Row& noise);

private:
  static constexpr int lump_octaves = 3, most_octaves = 7;

  double size_, finest_;
  std::array<std::uint32_t, Drift::phases> seeds_;
  std::array<std::array<Worley, lump_octaves>, Drift::phases> worley_;
};

} // namespace firetwin::flow
