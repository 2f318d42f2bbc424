#pragma once

#include "tiles/bytes.hpp"

#include <string>

namespace firetwin::tiles {

enum class ContentType { b3dm, i3dm, cmpt, pnts, glb, gltf, tileset, subtree };

/// What content is, by its first bytes; JSON by its keys. The name of a file tells nothing.
/// @throws InputError when it is none of these, or is JSON that cannot be parsed
ContentType detect_content_type(Bytes content, const std::string& name);

/// "b3dm", "i3dm" and so on.
const char* name_of(ContentType type);

} // namespace firetwin::tiles
