#pragma once

#include "tiles/bytes.hpp"
#include "tiles/json.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace firetwin::tiles {

/// Validated EXT_meshopt_compression of a buffer view.
struct MeshoptView {
  std::size_t count = 0;
  std::size_t stride = 0; ///< bytes
  std::string mode;       ///< ATTRIBUTES, TRIANGLES or INDICES
  std::string filter;     ///< NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL
};

/// @throws InputError if a value is not valid for the decoder
MeshoptView read_meshopt(const Node& extension);

/// Decompresses a view to count x stride bytes.
/// @throws InputError if the data is damaged
std::vector<std::uint8_t> decompress_meshopt(const MeshoptView& view, Bytes compressed,
                                             const Node& extension);

} // namespace firetwin::tiles
