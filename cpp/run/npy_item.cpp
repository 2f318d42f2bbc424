#include "run/npy_item.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace firetwin::run {
namespace {

static_assert(std::endian::native == std::endian::little, "npy files are read as little-endian");

/// 2^128 - 2^103, the smallest double that rounds to an infinite float.
constexpr double beyond_float = 0x1.ffffffp127;

template <class Item, bool swapped> Item load(const char* bytes) {
  std::array<char, sizeof(Item)> copy{};
  std::memcpy(copy.data(), bytes, sizeof(Item));
  if constexpr (swapped) {
    std::reverse(copy.begin(), copy.end());
  }
  return std::bit_cast<Item>(copy);
}

template <class Item, bool swapped, class T>
std::optional<std::size_t> convert_all(std::span<const char> bytes, std::span<T> out) {
  std::optional<std::size_t> too_large;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Item value = load<Item, swapped>(bytes.data() + i * sizeof(Item));
    if constexpr (std::is_same_v<Item, double> && std::is_same_v<T, float>) {
      if (!too_large && std::isfinite(value) && std::abs(value) >= beyond_float) {
        too_large = i;
      }
    }
    out[i] = static_cast<T>(value);
  }
  return too_large;
}

template <class Item, class T>
std::optional<std::size_t> convert_either(const NpyItem& item, std::span<const char> bytes,
                                          std::span<T> out) {
  return item.swapped ? convert_all<Item, true>(bytes, out) : convert_all<Item, false>(bytes, out);
}

} // namespace

std::optional<NpyItem> parse_item(std::string_view descr) {
  if (descr.size() != 3) {
    return std::nullopt;
  }
  const char order = descr[0], kind = descr[1];
  const auto size = static_cast<std::size_t>(descr[2] - '0');
  const bool integer = kind == 'i' || kind == 'u';
  const bool known = (integer && (size == 1 || size == 2 || size == 4 || size == 8)) ||
                     (kind == 'f' && (size == 4 || size == 8));
  if (!known || (order != '<' && order != '>' && !(order == '|' && size == 1))) {
    return std::nullopt;
  }
  return NpyItem{kind, size, order == '>'};
}

template <class T>
std::optional<std::size_t> convert(const NpyItem& item, std::span<const char> bytes,
                                   std::span<T> out) {
  if (item.kind == 'f') {
    return item.size == 4 ? convert_either<float>(item, bytes, out)
                          : convert_either<double>(item, bytes, out);
  }
  const bool sign = item.kind == 'i';
  switch (item.size) {
  case 1:
    return sign ? convert_either<std::int8_t>(item, bytes, out)
                : convert_either<std::uint8_t>(item, bytes, out);
  case 2:
    return sign ? convert_either<std::int16_t>(item, bytes, out)
                : convert_either<std::uint16_t>(item, bytes, out);
  case 4:
    return sign ? convert_either<std::int32_t>(item, bytes, out)
                : convert_either<std::uint32_t>(item, bytes, out);
  default:
    return sign ? convert_either<std::int64_t>(item, bytes, out)
                : convert_either<std::uint64_t>(item, bytes, out);
  }
}

template std::optional<std::size_t> convert(const NpyItem&, std::span<const char>,
                                            std::span<float>);
template std::optional<std::size_t> convert(const NpyItem&, std::span<const char>,
                                            std::span<double>);

} // namespace firetwin::run
