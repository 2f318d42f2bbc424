#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace firetwin::run {

/// How one number lies in a .npy file.
struct NpyItem {
  char kind = 'f';      ///< 'f' floating point, 'i' signed, 'u' unsigned, as in NumPy
  std::size_t size = 4; ///< bytes
  bool swapped = false; ///< big-endian
};

/// The numbers that are read: floats of 4 and 8 bytes, integers of 1, 2, 4 and 8, in either byte
/// order. Nothing for any other type.
std::optional<NpyItem> parse_item(std::string_view descr);

/// Numbers of a file, each as the nearest T. @return the index of the first float64 that is too
/// large for a T, if there is one
template <class T>
std::optional<std::size_t> convert(const NpyItem& item, std::span<const char> bytes,
                                   std::span<T> out);

extern template std::optional<std::size_t> convert(const NpyItem&, std::span<const char>,
                                                   std::span<float>);
extern template std::optional<std::size_t> convert(const NpyItem&, std::span<const char>,
                                                   std::span<double>);

} // namespace firetwin::run
