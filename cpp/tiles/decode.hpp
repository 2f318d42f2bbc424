#pragma once

#include "tiles/bytes.hpp"
#include "tiles/matrix.hpp"
#include "tiles/tile.hpp"

#include <string>
#include <vector>

/// Decoding of 3-D Tiles content: b3dm, i3dm, cmpt, pnts (3D Tiles 1.0, OGC 18-053r2), glb and glTF
/// (3D Tiles 1.1, OGC 22-025r4). Nothing is opened or fetched: files beside the content come as
/// resources. Pictures are handed on as they are. Every count is checked here, but Draco trusts its
/// own data: content from elsewhere belongs into a process with limits of memory and time.
namespace firetwin::tiles {

/// Which axis of a tileset's glTF points up (its asset.gltfUpAxis).
enum class UpAxis { x, y, z };

struct DecodeOptions {
  Matrix to_scene = identity; ///< the content's frame (z up) to the scene's
  Matrix to_earth =
      identity; ///< the content's frame to the Earth-centred one: i3dm's EAST_NORTH_UP
  UpAxis up_axis = UpAxis::y;
};

/// @param name of the content, for messages
/// @throws InputError when the content is damaged, asks for more than the limits, or cannot be read
/// @throws std::invalid_argument when a matrix is not finite, not affine or flattens
Tile decode(Bytes content, const std::string& name, const Resources& resources,
            const DecodeOptions& options);

/// uris, relative to the content, of the files that `decode` lacks; pictures are not among them.
/// A file may need others: ask again with it.
/// @throws InputError
std::vector<std::string> list_missing_resources(Bytes content, const std::string& name,
                                                const Resources& resources);

} // namespace firetwin::tiles
