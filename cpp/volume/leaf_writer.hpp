#pragma once

#include "volume/leaf.hpp"

#include <array>
#include <cstdint>
#include <sstream>
#include <string>

namespace firetwin::volume {

using HalfValues = std::array<std::uint16_t, leaf_voxels>;

/// Serialises the values of one grid leaf by leaf, in the format of LeafNode::writeBuffers if all
/// inactive values are the background.
class LeafWriter {
public:
  /// Compresses and writes `count` values of `value_size` bytes each.
  using Compress = void (*)(std::ostream& out, const char* values, std::size_t value_size,
                            std::size_t count);

  /// @param is_half round values to half precision
  LeafWriter(bool is_half, Compress compress) : half_(is_half), compress_(compress) {}

  void write(const LeafMask& mask, const LeafValues& values);

  /// Returns everything that was written; call it last.
  std::string take() { return std::move(stream_).str(); }

private:
  /// Writes the mask and `count` active values of `value_size` bytes each.
  void put(const LeafMask& mask, const char* values, std::size_t value_size, std::size_t count);

  bool half_;
  Compress compress_;
  std::ostringstream stream_{std::ios_base::binary};
  HalfValues halves_;
  LeafValues values_;
  std::string known_; ///< the previous leaf, uncompressed and compressed
  std::string known_bytes_;
};

} // namespace firetwin::volume
