#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace firetwin::run {

/// Element type of a .npy file.
struct NpyItem {
  char kind = 'f';      ///< 'f' floating point, 'i' signed, 'u' unsigned, as in NumPy
  std::size_t size = 4; ///< bytes
  bool swapped = false; ///< big-endian
};

/// Parses a supported element type: float32, float64 and integers of 1, 2, 4 and 8 bytes, in either
/// byte order. Empty for other types.
std::optional<NpyItem> parse_item(std::string_view descr);

/// Converts numbers to the nearest T. @return the index of the first float64 that is too large for
/// a T, if there is one
template <class T>
std::optional<std::size_t> convert(const NpyItem& item, std::span<const char> bytes,
                                   std::span<T> out);

extern template std::optional<std::size_t> convert(const NpyItem&, std::span<const char>,
                                                   std::span<float>);
extern template std::optional<std::size_t> convert(const NpyItem&, std::span<const char>,
                                                   std::span<double>);

} // namespace firetwin::run
