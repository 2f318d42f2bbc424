#pragma once

#include "tiles/bytes.hpp"
#include "tiles/matrix.hpp"
#include "tiles/tile.hpp"

#include <string>
#include <vector>

/// Decoder of 3D Tiles content: b3dm, i3dm, cmpt, pnts (3D Tiles 1.0, OGC 18-053r2), glb and glTF
/// (3D Tiles 1.1, OGC 22-025r4). No file is opened and nothing is downloaded: external files are
/// passed as resources. Images stay encoded. All counts are checked here, but Draco does not
/// validate its data: decode untrusted content in a process with memory and time limits.
namespace firetwin::tiles {

/// Up axis of the glTF contents of a tileset (asset.gltfUpAxis).
enum class UpAxis { x, y, z };

struct DecodeOptions {
  Matrix to_scene = identity; ///< from the content's frame (z up) to the scene's
  Matrix to_earth =
      identity; ///< from the content's frame to Earth-centred metres, for EAST_NORTH_UP of i3dm
  UpAxis up_axis = UpAxis::y;
};

/// @param name identifies the content in error messages
/// @throws InputError if the content is damaged, exceeds a limit or is not supported
/// @throws std::invalid_argument if a matrix is not finite, not affine or singular
Tile decode(Bytes content, const std::string& name, const Resources& resources,
            const DecodeOptions& options);

/// Lists the uris, relative to the content, of external files that `decode` needs in addition to
/// `resources`. Images are optional and not listed. Call it again with the new files until the list
/// is empty, because a model may need further buffers.
/// @throws InputError
std::vector<std::string> list_missing_resources(Bytes content, const std::string& name,
                                                const Resources& resources);

} // namespace firetwin::tiles
