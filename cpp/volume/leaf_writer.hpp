#pragma once

#include "volume/leaf.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <sstream>
#include <string>

namespace firetwin::volume {

using HalfValues = std::array<std::uint16_t, leaf_voxels>;

/// Values of one grid in half precision, leaf after leaf, as LeafNode::writeBuffers writes them
/// when all values that are not active are the background.
class LeafWriter {
public:
  /// @param active numbers of the voxels that are on in `mask`
  void write(const LeafMask& mask, std::span<const openvdb::Index> active,
             const LeafValues& values);

  /// All that was written; the last thing to ask for.
  std::string take() { return std::move(stream_).str(); }

private:
  std::ostringstream stream_{std::ios_base::binary};
  HalfValues halves_;
  HalfValues known_; ///< the leaf before
  std::size_t known_count_ = 0;
  std::string known_bytes_;
};

} // namespace firetwin::volume
