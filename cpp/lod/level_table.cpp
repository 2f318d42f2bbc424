#include "lod/level_table.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace firetwin::lod {

LevelTable::LevelTable(std::vector<double> thresholds, std::vector<double> multipliers)
    : thresholds_(std::move(thresholds)), multipliers_(std::move(multipliers)) {
  const auto not_finite = [](double v) { return !std::isfinite(v); };
  if (std::any_of(thresholds_.begin(), thresholds_.end(), not_finite) ||
      std::any_of(multipliers_.begin(), multipliers_.end(), not_finite)) {
    throw std::invalid_argument("thresholds and multipliers must be finite");
  }
  if (std::adjacent_find(thresholds_.begin(), thresholds_.end(), std::greater_equal<>()) !=
      thresholds_.end()) {
    throw std::invalid_argument("thresholds must ascend");
  }
  if (multipliers_.size() != thresholds_.size() + 1 || multipliers_.size() > 256) {
    throw std::invalid_argument(
        "multipliers must have one more value than thresholds, and at most 256");
  }
}

std::uint8_t LevelTable::level(double distance) const {
  std::uint8_t detail = 0;
  for (const double threshold : thresholds_) {
    detail = static_cast<std::uint8_t>(detail + !(distance <= threshold));
  }
  return detail;
}

void LevelTable::levels(std::span<const double> distance, std::span<std::uint8_t> out) const {
  std::transform(distance.begin(), distance.end(), out.begin(),
                 [this](double d) { return level(d); });
}

void LevelTable::multiplier(std::span<const double> distance, std::span<double> out) const {
  std::transform(distance.begin(), distance.end(), out.begin(),
                 [this](double d) { return multipliers_[level(d)]; });
}

} // namespace firetwin::lod
