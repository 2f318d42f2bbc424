#pragma once

#include "tiles/json.hpp"
#include "tiles/matrix.hpp"
#include "tiles/primitives.hpp"

#include <vector>

namespace firetwin::tiles {

/// Adds the primitives of all nodes in a document's scene once per matrix of `to_scene`, which
/// transform the document's coordinates to the scene's.
/// @throws InputError if a node is reached twice, for example in a cycle
void draw_nodes(const Node& root, const std::vector<Matrix>& to_scene, const Reader& reader);

} // namespace firetwin::tiles
