#include "tiles/image_header.hpp"

#include <string_view>

namespace firetwin::tiles {
namespace {

bool holds(Bytes file, std::size_t offset, std::string_view text) {
  return within(offset, text.size(), file.size()) &&
         std::string_view(reinterpret_cast<const char*>(file.data()) + offset, text.size()) == text;
}

/// Reads a big-endian number.
std::uint32_t big_endian(Bytes file, std::size_t offset, std::size_t bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) {
    value = value << 8U | file[offset + i];
  }
  return value;
}

std::uint32_t little_endian(Bytes file, std::size_t offset, std::size_t bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = bytes; i-- > 0;) {
    value = value << 8U | file[offset + i];
  }
  return value;
}

/// ISO 15948: the first chunk is IHDR.
ImageHeader read_png(Bytes file) {
  if (!holds(file, 12, "IHDR") || file.size() < 24) {
    return {"png"};
  }
  return {"png", big_endian(file, 16, 4), big_endian(file, 20, 4)};
}

/// ITU-T T.81: the size is in a start-of-frame segment, C0 to CF except C4, C8 and CC.
ImageHeader read_jpeg(Bytes file) {
  for (std::size_t at = 2; within(at, 9, file.size()) && file[at] == 0xFF;) {
    const std::uint8_t marker = file[at + 1];
    if (marker == 0xFF) { // fill byte
      ++at;
    } else if (marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 &&
               marker != 0xCC) {
      return {"jpeg", big_endian(file, at + 7, 2), big_endian(file, at + 5, 2)};
    } else {
      at += 2 + big_endian(file, at + 2, 2);
    }
  }
  return {"jpeg"};
}

/// RFC 9649: VP8X, lossless VP8L or lossy VP8.
ImageHeader read_webp(Bytes file) {
  if (file.size() < 30) {
    return {"webp"};
  }
  if (holds(file, 12, "VP8X")) {
    return {"webp", little_endian(file, 24, 3) + 1, little_endian(file, 27, 3) + 1};
  }
  if (holds(file, 12, "VP8L") && file[20] == 0x2F) {
    const std::uint32_t bits = little_endian(file, 21, 4);
    return {"webp", (bits & 0x3FFFU) + 1, (bits >> 14U & 0x3FFFU) + 1};
  }
  if (holds(file, 12, "VP8 ") && holds(file, 23, "\x9D\x01\x2A")) {
    return {"webp", little_endian(file, 26, 2) & 0x3FFFU, little_endian(file, 28, 2) & 0x3FFFU};
  }
  return {"webp"};
}

} // namespace

ImageHeader read_image_header(Bytes file) {
  if (holds(file, 0, "\xFF\xD8\xFF")) {
    return read_jpeg(file);
  }
  if (holds(file, 0, "\x89PNG\r\n\x1A\n")) {
    return read_png(file);
  }
  if (holds(file, 0, "RIFF") && holds(file, 8, "WEBP")) {
    return read_webp(file);
  }
  if (holds(file, 0, "\xABKTX 20\xBB\r\n\x1A\n")) {
    return {"ktx2"};
  }
  return {};
}

} // namespace firetwin::tiles
