#pragma once

#include "tiles/json.hpp"
#include "tiles/matrix.hpp"
#include "tiles/primitives.hpp"

#include <vector>

namespace firetwin::tiles {

/// Adds what the nodes of a document's scene draw, once for each of `to_scene`, which take the
/// document's coordinates to the scene's.
/// @throws InputError where a node is reached twice, which includes a circle of nodes
void draw_nodes(const Node& root, const std::vector<Matrix>& to_scene, const Reader& reader);

} // namespace firetwin::tiles
