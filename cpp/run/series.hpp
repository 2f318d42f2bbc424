#pragma once

#include "run/npy.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace firetwin::run {

/// One field at all model times: either one .npy [nt, ny, nx], or one file 000000.txt or 000000.npy
/// per time. Nothing but names and headers is read before it is asked for.
class Series {
public:
  /// @throws InputError when the array is not [any, rows, columns].
  Series(NpyFile file, std::size_t rows, std::size_t columns, std::optional<float> no_data);
  Series(std::vector<std::filesystem::path> frames, std::size_t rows, std::size_t columns,
         std::optional<float> no_data);

  std::size_t size() const { return file_ ? file_->shape()[0] : frames_.size(); }
  std::size_t cells() const { return rows_ * columns_; }
  /// Whether reading one time goes through all of the file, as in Fortran order.
  bool scattered() const { return file_ && file_->scattered(); }
  /// The file that holds a time, for messages.
  const std::filesystem::path& path(std::size_t index) const;

  /// The grid [ny, nx] at one time, no_data as NaN. Several threads may read at once.
  /// @throws std::out_of_range, InputError
  void read(std::size_t index, std::span<float> out) const;

private:
  std::optional<NpyFile> file_;
  std::vector<std::filesystem::path> frames_;
  std::size_t rows_;
  std::size_t columns_;
  std::optional<float> no_data_;
};

} // namespace firetwin::run
