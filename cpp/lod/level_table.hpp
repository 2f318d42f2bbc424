#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::lod {

/// Level of detail by distance; level 0 has the most detail (FIRETWIN paper, equations 4 and 5:
/// thresholds of 1500 m and 3500 m, particle multipliers 1.0, 0.7 and 0.4).
class LevelTable {
public:
  /// @param thresholds ascending distances, m; level i ends at thresholds[i], included
  /// @param multipliers one per level, one more than thresholds
  /// @throws std::invalid_argument
  explicit LevelTable(std::vector<double> thresholds = {1500.0, 3500.0},
                      std::vector<double> multipliers = {1.0, 0.7, 0.4});

  const std::vector<double>& thresholds() const { return thresholds_; }
  const std::vector<double>& multipliers() const { return multipliers_; }

  /// Level at a distance (m); NaN gives the last level.
  std::uint8_t level(double distance) const;
  void levels(std::span<const double> distance, std::span<std::uint8_t> out) const;
  void multiplier(std::span<const double> distance, std::span<double> out) const;

private:
  std::vector<double> thresholds_;
  std::vector<double> multipliers_;
};

} // namespace firetwin::lod
