#pragma once

#include "run/npy.hpp"

#include <oneapi/tbb/collaborative_call_once.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace firetwin::run {

/// A constant 2-D field. For a .npy in C order only the header is read in advance, and rows can be
/// read separately; other files are loaded completely. Thread-safe.
class Plane {
public:
  using Make = std::function<std::vector<float>()>;

  /// @throws InputError for an invalid file or another shape
  /// @param zero subtracted from every value before conversion to float
  Plane(const std::filesystem::path& path, std::size_t rows, std::size_t columns,
        std::optional<float> no_data, double zero = 0.0);
  /// A field that `make` computes on first use.
  Plane(Make make, std::size_t rows, std::size_t columns);

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }

  /// All values [rows columns], with no_data as NaN. @throws InputError
  const std::vector<float>& values() const;
  /// Reads values from row `first` on until `out` is full. @throws std::out_of_range, InputError
  void read(std::size_t first, std::span<float> out) const;
  /// Calls visit(std::span<const float>) for all values, in blocks of rows.
  template <class Visit> void each(const Visit& visit) const {
    const std::size_t step = rows_at_once();
    std::vector<float> part;
    for (std::size_t row = 0; row < rows_; row += step) {
      part.resize(std::min(step, rows_ - row) * columns_);
      read(row, part);
      visit(std::span<const float>(part));
    }
  }

private:
  std::size_t rows_at_once() const;
  std::vector<float> read_all() const;
  void read_file(std::size_t first, std::span<float> out) const;
  void narrow(std::span<const double> values, std::span<float> out) const;

  std::size_t rows_, columns_;
  std::optional<float> no_data_;
  double zero_ = 0.0;
  std::optional<NpyFile> file_;
  Make make_;
  mutable tbb::collaborative_once_flag once_; // std::once_flag hangs after an error with MinGW
  mutable std::vector<float> values_;
};

} // namespace firetwin::run
