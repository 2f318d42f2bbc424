#pragma once

#include "base/simd.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::flames {

/// Optical properties of gas in a step, relative to a flame's greatest extinction.
struct FlameOptics {
  float extinction;           ///< of flames
  float hot;                  ///< extinction times heat
  std::array<float, 3> light; ///< extinction times radiance
  float soot;                 ///< extinction of cooled soot
};

/// Optical properties by the stored mixture fraction and height, integrated beforehand over all
/// mixture fractions that a step passes: thin sheets are seen whatever the steps are
/// (K. Engel, M. Kraus and T. Ertl 2001, "High-quality pre-integrated volume rendering").
class FlameTable {
public:
  /// @param visible radiance at evenly spaced heats
  explicit FlameTable(std::span<const std::array<float, 3>> visible);

  /// Averages over a step between two codes, 0 to 1, at a height in flame lengths.
  FlameOptics between(float first, float second, float height) const;
  /// Returns the radiance at a heat.
  std::array<float, 3> radiance(float heat) const;

private:
  static constexpr std::size_t codes = 513, heights = 13;
  static constexpr float tallest = 1.6F; ///< height of the last row, flame lengths
  /// Sums over codes: extinction, hot, light, soot.
  using Row = std::vector<std::array<float, lane_count>>;

  std::vector<std::array<float, 3>> visible_;
  std::array<Row, heights> rows_;
};

} // namespace firetwin::flames
