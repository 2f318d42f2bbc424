#pragma once

#include "tiles/accessors.hpp"
#include "tiles/assembler.hpp"
#include "tiles/buffers.hpp"
#include "tiles/json.hpp"
#include "tiles/materials.hpp"

#include <memory>
#include <vector>

namespace firetwin::tiles {

/// Readers of the parts of a glTF document.
struct Reader {
  Buffers& buffers;
  Accessors& accessors;
  Materials& materials;
  Assembler& assembler;
};

/// Reads the primitives of a mesh. Lines and primitives without positions or finite vertices are
/// dropped.
/// @throws InputError
std::vector<std::shared_ptr<const Primitive>> read_mesh(const Node& mesh, const Reader& reader);

} // namespace firetwin::tiles
