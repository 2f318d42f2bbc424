#pragma once

#include "tiles/bytes.hpp"

#include <string>

namespace firetwin::tiles {

enum class ContentType { b3dm, i3dm, cmpt, pnts, glb, gltf, tileset, subtree };

/// Detects the content type from the magic bytes, or from the keys of JSON. File names are ignored.
/// @throws InputError if the type is unknown or JSON cannot be parsed
ContentType detect_content_type(Bytes content, const std::string& name);

/// Name of a content type, such as "b3dm".
const char* name_of(ContentType type);

} // namespace firetwin::tiles
