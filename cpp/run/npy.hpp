#pragma once

#include "io/file.hpp"
#include "run/npy_item.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace firetwin::run {

/// A .npy file (numpy.lib.format, versions 1 to 3) of floats of 4 or 8 bytes or of integers, in
/// either byte order, in C or Fortran order. Nothing else is read: no pickles, no structures.
class NpyFile {
public:
  /// @throws InputError for anything else, and when the file's length is not the one that its
  /// header
  ///         asks for.
  explicit NpyFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return file_.path(); }
  const std::vector<std::size_t>& shape() const { return shape_; }

  /// Whether array[i] lies all over the file, as in Fortran order: reading it goes through the
  /// whole file.
  bool scattered() const { return fortran_order_ && shape_.front() > 1; }

  /// array[first], array[first + 1] and so on in C order, as many as fill `out` exactly, each value
  /// as the nearest T. Only what is asked for is read and converted.
  /// @throws InputError for a float64 value that is too large for a float.
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
  bool fortran_order_ = false; ///< and of two dimensions or more
  std::uint64_t data_offset_ = 0;
  std::size_t part_ = 1; ///< values in array[i]
};

/// "(3, 144, 144)"
std::string shape_text(std::span<const std::size_t> shape);

} // namespace firetwin::run
