#pragma once

#include "tiles/bytes.hpp"
#include "tiles/json.hpp"

#include <optional>
#include <string>

namespace firetwin::tiles {

/// A glTF document and its binary chunk.
struct Container {
  Node root;
  std::optional<Bytes> binary;
};

/// Opens a glb or a JSON glTF. Bytes after the length in a glb header are ignored. Rejects glTF 1
/// and documents that require an unsupported extension.
/// @throws InputError
Container open_gltf(Bytes content, const std::string& name);

} // namespace firetwin::tiles
