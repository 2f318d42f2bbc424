#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::lod {

/// How much detail is shown at a distance: 0 for the most (FIRETWIN paper, equations 4 and 5:
/// 1500 m and 3500 m, particle multipliers 1.0, 0.7 and 0.4).
class Table {
public:
  /// @param thresholds ascending distances in m: detail i reaches up to and including thresholds[i]
  /// @param multipliers one more than thresholds
  /// @throws std::invalid_argument
  explicit Table(std::vector<double> thresholds = {1500.0, 3500.0},
                 std::vector<double> multipliers = {1.0, 0.7, 0.4});

  const std::vector<double>& thresholds() const { return thresholds_; }
  const std::vector<double>& multipliers() const { return multipliers_; }

  /// NaN gives the last.
  std::uint8_t detail(double distance) const;
  void details(std::span<const double> distance, std::span<std::uint8_t> out) const;
  void multiplier(std::span<const double> distance, std::span<double> out) const;

private:
  std::vector<double> thresholds_;
  std::vector<double> multipliers_;
};

} // namespace firetwin::lod
