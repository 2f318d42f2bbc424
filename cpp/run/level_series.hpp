#pragma once

#include "run/npy.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace firetwin::run {

/// A field on terrain-following levels at all model times: one .npy [nt, nz, ny, nx], or [nz, ny,
/// nx] for a constant field. Only the header is read in advance.
class LevelSeries {
public:
  /// @param times number of model times @param steady allow [nz, ny, nx]
  /// @throws InputError if the array has another shape or fewer than two levels
  LevelSeries(NpyFile file, std::size_t times, std::size_t rows, std::size_t columns, bool steady,
              std::optional<float> no_data);

  std::size_t levels() const { return levels_; }
  std::size_t cells() const { return cells_; } ///< levels x rows x columns
  const std::filesystem::path& path() const { return file_.path(); }
  /// True if reading one time scans the complete file, as in Fortran order.
  bool scattered() const { return !steady_ && file_.scattered(); }

  /// Reads the field [nz, ny, nx] at one time, with no_data as NaN. Thread-safe.
  /// @throws std::out_of_range, InputError
  void read(std::size_t index, std::span<float> out) const;
  /// Reads the field at `time`, interpolated linearly. `times` must ascend and contain `time` in
  /// their range.
  void read_at(double time, std::span<const double> times, std::span<float> out) const;

private:
  NpyFile file_;
  std::size_t times_;
  bool steady_;
  std::size_t levels_;
  std::size_t cells_;
  std::optional<float> no_data_;
};

} // namespace firetwin::run
