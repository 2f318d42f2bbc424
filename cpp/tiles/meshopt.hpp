#pragma once

#include "tiles/bytes.hpp"
#include "tiles/json.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace firetwin::tiles {

/// EXT_meshopt_compression of a buffer view, checked.
struct MeshoptView {
  std::size_t count = 0;
  std::size_t stride = 0; ///< bytes
  std::string mode;       ///< ATTRIBUTES, TRIANGLES or INDICES
  std::string filter;     ///< NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL
};

/// @throws InputError when a number is not one that the decoder may be given
MeshoptView read_meshopt(const Node& extension);

/// count x stride bytes.
/// @throws InputError where the data is damaged
std::vector<std::uint8_t> decompress_meshopt(const MeshoptView& view, Bytes compressed,
                                             const Node& extension);

} // namespace firetwin::tiles
