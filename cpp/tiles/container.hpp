#pragma once

#include "tiles/bytes.hpp"
#include "tiles/json.hpp"

#include <optional>
#include <string>

namespace firetwin::tiles {

/// A glTF document and the binary chunk that comes with it.
struct Container {
  Node root;
  std::optional<Bytes> binary;
};

/// Opens a glb, or glTF as JSON. A glb ends where its own header says. Refuses glTF 1 and unknown
/// extensions that the document requires.
/// @throws InputError
Container open_gltf(Bytes content, const std::string& name);

} // namespace firetwin::tiles
