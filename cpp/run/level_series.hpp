#pragma once

#include "run/npy.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace firetwin::run {

/// A field on terrain-following levels at all model times, one .npy [nt, nz, ny, nx]; or the same
/// at all times, [nz, ny, nx]. Nothing but the header is read before it is asked for.
class LevelSeries {
public:
  /// @param times of the run; @param steady whether [nz, ny, nx] is allowed
  /// @throws InputError when the array has another shape or fewer than two levels.
  LevelSeries(NpyFile file, std::size_t times, std::size_t rows, std::size_t columns, bool steady,
              std::optional<float> no_data);

  std::size_t levels() const { return levels_; }
  std::size_t cells() const { return cells_; } ///< levels x rows x columns
  const std::filesystem::path& path() const { return file_.path(); }
  /// Whether reading one time goes through all of the file, as in Fortran order.
  bool scattered() const { return !steady_ && file_.scattered(); }

  /// The field [nz, ny, nx] at one time, no_data as NaN. Several threads may read at once.
  /// @throws std::out_of_range, InputError
  void read(std::size_t index, std::span<float> out) const;
  /// The field at `time`, linear between the two times around it; `times` ascend and `time` lies
  /// within them.
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
