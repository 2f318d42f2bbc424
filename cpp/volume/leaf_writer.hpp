#pragma once

#include "volume/leaf.hpp"

#include <array>
#include <cstdint>
#include <sstream>
#include <string>

namespace firetwin::volume {

using HalfValues = std::array<std::uint16_t, leaf_voxels>;

/// Values of one grid, leaf after leaf, as LeafNode::writeBuffers writes them when all values that
/// are not active are the background.
class LeafWriter {
public:
  /// @param is_half whether values are rounded to half precision
  explicit LeafWriter(bool is_half) : half_(is_half) {}

  void write(const LeafMask& mask, const LeafValues& values);

  /// All that was written; the last thing to ask for.
  std::string take() { return std::move(stream_).str(); }

private:
  /// `count` active values of `value_size` bytes each.
  void put(const LeafMask& mask, const char* values, std::size_t value_size, std::size_t count);

  bool half_;
  std::ostringstream stream_{std::ios_base::binary};
  HalfValues halves_;
  LeafValues values_;
  std::string known_; ///< the leaf before, and what it became
  std::string known_bytes_;
};

} // namespace firetwin::volume
