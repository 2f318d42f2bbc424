#pragma once

#include "io/metadata.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace firetwin::sensor {

struct Image {
  std::size_t height = 0;
  std::size_t width = 0;
  std::size_t channels = 0;
  std::vector<float> pixels; ///< [height width channels], top row first; integers scaled to 0..1
  std::vector<std::string> names; ///< of the channels
};

/// Reads a PNG, OpenEXR, TIFF or JPEG file, told apart by content; no other reader of OpenImageIO
/// is ever started. At most 256 million values (1 GB) and 64 channels. @throws InputError
Image read_image(const std::filesystem::path& path);

/// Writes .png (8 bit, values clamped to 0..1) or .exr (32-bit float, ZIP), all of it or nothing
/// (see io/new_file.hpp). @param names of an EXR's channels, as many as there are; none: R, G, B...
/// @throws InputError when that cannot be done.
void write_image(const std::filesystem::path& path, std::span<const float> pixels,
                 std::size_t height, std::size_t width, std::size_t channels,
                 const io::Metadata& metadata, const std::vector<std::string>& names = {});

} // namespace firetwin::sensor
