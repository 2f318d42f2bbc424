#pragma once

#include "tiles/bytes.hpp"

#include <cstdint>
#include <string>

namespace firetwin::tiles {

/// Format and size of an encoded image, from its header. The size is 0 if the header is damaged.
struct ImageHeader {
  std::string kind; ///< "jpeg", "png", "webp" or "ktx2"; empty for other formats
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

/// Reads the header without decoding the image.
ImageHeader read_image_header(Bytes file);

} // namespace firetwin::tiles
