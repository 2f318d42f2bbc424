#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <span>
#include <string>

namespace firetwin::tiles {

static_assert(std::endian::native == std::endian::little, "glTF and 3D Tiles are little-endian");

using Bytes = std::span<const std::uint8_t>;

/// External files of a content, by uri relative to it.
using Resources = std::map<std::string, Bytes, std::less<>>;

/// Loads a number from an address of any alignment.
template <class T> T load(const std::uint8_t* place) {
  T value{};
  std::memcpy(&value, place, sizeof(T));
  return value;
}

/// True if `length` bytes from `offset` on lie within `size` bytes.
inline bool within(std::size_t offset, std::size_t length, std::size_t size) {
  return offset <= size && length <= size - offset;
}

} // namespace firetwin::tiles
