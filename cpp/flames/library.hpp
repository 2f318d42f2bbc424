#pragma once

#include "flames/blocks.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace firetwin::flames {

/// Solved fires: lines in calm air and in winds, from the calmest to the strongest, and crowns.
/// Each kind has some blocks that differ by the seed of their eddies.
class FlameLibrary {
public:
  static constexpr std::size_t most_kinds = 4; ///< of lines
  /// Part of the way from one wind to the next at which flames change from one kind to the other.
  static constexpr std::array<float, 2> change{0.35F, 0.75F};
  using Kind = std::vector<std::shared_ptr<const FlameBlock>>;

  /// @throws std::invalid_argument if a kind has no block, or lines are not sorted by wind
  FlameLibrary(std::vector<Kind> lines, Kind crowns);

  std::span<const Kind> lines() const { return lines_; }
  const Kind& crowns() const { return crowns_; }

  /// How far the flames of a line reach ahead of the front and behind it, and up, in flame lengths.
  float ahead() const { return ahead_; }
  float behind() const { return behind_; }
  float top() const { return top_; }

private:
  std::vector<Kind> lines_;
  Kind crowns_;
  float ahead_ = 0.0F, behind_ = 0.0F, top_ = 0.0F;
};

} // namespace firetwin::flames
