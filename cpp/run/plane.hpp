#pragma once

#include "run/npy.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace firetwin::run {

/// A grid of one field that does not change. Of a .npy in C order nothing but the header is read
/// before it is asked for, and rows can be had without the rest; everything else is there as a
/// whole. All of it may be used from several threads.
class Plane {
public:
  using Make = std::function<std::vector<float>()>;

  /// @throws InputError for what the file's header or text is refused for, and for another shape.
  /// @param zero what is taken from every value before it is narrowed to a float
  Plane(const std::filesystem::path& path, std::size_t rows, std::size_t columns,
        std::optional<float> no_data, double zero = 0.0);
  /// Values that are made when they are first asked for.
  Plane(Make make, std::size_t rows, std::size_t columns);

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }

  /// [rows columns], no_data as NaN. @throws InputError
  const std::vector<float>& values() const;
  /// As many values from row `first` on as fill `out`. @throws std::out_of_range, InputError
  void read(std::size_t first, std::span<float> out) const;
  /// Calls visit(std::span<const float>) for all values, some rows at a time.
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
  mutable std::once_flag once_;
  mutable std::vector<float> values_;
};

} // namespace firetwin::run
