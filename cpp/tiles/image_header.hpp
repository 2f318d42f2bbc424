#pragma once

#include "tiles/bytes.hpp"

#include <cstdint>
#include <string>

namespace firetwin::tiles {

/// What the first bytes of an encoded picture say. 0 pixels where the header is damaged.
struct ImageHeader {
  std::string kind; ///< "jpeg", "png", "webp" or "ktx2"; nothing for other files
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

/// Reads the header alone; nothing is decoded.
ImageHeader read_image_header(Bytes file);

} // namespace firetwin::tiles
