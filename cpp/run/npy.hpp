#pragma once

#include "io/file.hpp"
#include "run/npy_item.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace firetwin::run {

/// A .npy file (numpy.lib.format, versions 1 to 3) of float32, float64 or integers, in either byte
/// order, in C or Fortran order. Pickles and structured arrays are rejected.
class NpyFile {
public:
  /// @throws InputError for other files, and if the length of the file does not match its header
  explicit NpyFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return file_.path(); }
  const std::vector<std::size_t>& shape() const { return shape_; }

  /// True if array[i] is scattered over the file, as in Fortran order: reading it scans the
  /// complete file.
  bool scattered() const { return fortran_order_ && shape_.front() > 1; }

  /// Reads array[first], array[first + 1] and so on in C order until `out` is full, each value
  /// rounded to the nearest T. Other parts of the file are not read.
  /// @throws InputError for a float64 value that is too large for a float
  void read(std::size_t first, std::span<float> out) const;
  void read(std::size_t first, std::span<double> out) const;

private:
  template <class T> void read_as(std::size_t first, std::span<T> out) const;
  template <class T>
  void convert_values(std::uint64_t begin, std::span<const char> bytes, std::span<T> out) const;
  void gather(std::size_t first, std::size_t count, std::span<char> out) const;

  io::File file_;
  std::vector<std::size_t> shape_;
  NpyItem item_;
  bool fortran_order_ = false; ///< Fortran order and at least two dimensions
  std::uint64_t data_offset_ = 0;
  std::size_t part_ = 1; ///< values in array[i]
};

/// Formats a shape as "(3, 144, 144)".
std::string shape_text(std::span<const std::size_t> shape);

} // namespace firetwin::run
