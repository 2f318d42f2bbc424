#pragma once

#include "io/file.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace firetwin::run {

/// A .npy file (numpy.lib.format, versions 1 to 3) of little-endian float32 or float64 in C order.
/// Nothing else is read: no pickles, no structures, no other byte order.
class NpyFile {
public:
  /// @throws InputError for anything else, and when the file's length is not the one that its
  /// header
  ///         asks for.
  explicit NpyFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return file_.path(); }
  const std::vector<std::size_t>& shape() const { return shape_; }

  /// Values first..first + out.size() of the flattened array, each as the nearest T.
  /// @throws InputError for a float64 value that is too large for a float.
  void read(std::uint64_t first, std::span<float> out) const;
  void read(std::uint64_t first, std::span<double> out) const;

private:
  io::File file_;
  std::vector<std::size_t> shape_;
  std::size_t item_size_ = 0;
  std::uint64_t data_offset_ = 0;
};

/// "(3, 144, 144)"
std::string shape_text(std::span<const std::size_t> shape);

} // namespace firetwin::run
