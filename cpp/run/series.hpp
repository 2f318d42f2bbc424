#pragma once

#include "run/npy.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace firetwin::run {

/// One field at all model times: one .npy [nt, ny, nx], or one file 000000.txt or 000000.npy per
/// time. Only names and headers are read in advance.
class Series {
public:
  /// @throws InputError unless the array is [any, rows, columns]
  Series(NpyFile file, std::size_t rows, std::size_t columns, std::optional<float> no_data);
  Series(std::vector<std::filesystem::path> frames, std::size_t rows, std::size_t columns,
         std::optional<float> no_data);

  /// The same field on another grid, resampled bilinearly on reading.
  /// @param from_y, from_x axes of the file @param to_y, to_x axes of the result
  Series onto(std::vector<double> from_y, std::vector<double> from_x, std::vector<double> to_y,
              std::vector<double> to_x) &&;

  std::size_t size() const { return file_ ? file_->shape()[0] : frames_.size(); }
  std::size_t rows() const { return axes_ ? axes_->to_y.size() : rows_; }       ///< of the result
  std::size_t columns() const { return axes_ ? axes_->to_x.size() : columns_; } ///< of the result
  std::size_t cells() const { return rows() * columns(); }
  /// True if reading one time scans the complete file, as in Fortran order.
  bool scattered() const { return file_ && file_->scattered(); }
  /// The file of a time, for messages.
  const std::filesystem::path& path(std::size_t index) const;

  /// Reads the grid [rows, columns] at one time, with no_data as NaN. Thread-safe.
  /// @throws std::out_of_range, InputError
  void read(std::size_t index, std::span<float> out) const;

private:
  struct Axes {
    std::vector<double> from_y, from_x, to_y, to_x;
  };
  void read_own(std::size_t index, std::span<float> out) const;

  std::optional<NpyFile> file_;
  std::vector<std::filesystem::path> frames_;
  std::size_t rows_;
  std::size_t columns_;
  std::optional<float> no_data_;
  std::optional<Axes> axes_; ///< set if the field is resampled
};

} // namespace firetwin::run
