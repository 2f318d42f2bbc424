#pragma once

#include "io/metadata.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace firetwin::sensor {

/// Decoded image.
struct Image {
  std::size_t height = 0;
  std::size_t width = 0;
  std::size_t channels = 0;
  std::vector<float> pixels; ///< [height width channels], top row first; integers scaled to 0..1
  std::vector<std::string> names; ///< channel names
};

/// Reads a PNG, OpenEXR, TIFF or JPEG file. The format is detected from its magic bytes; no other
/// reader of OpenImageIO is started. Limits: 256 million values (1 GB) and 64 channels.
/// @throws InputError
Image read_image(const std::filesystem::path& path);

/// Decodes an encoded image in memory, with the formats and limits of `read_image`.
/// @param name replaces the path in error messages
/// @throws InputError
Image decode_image(std::span<const unsigned char> data, const std::string& name);

/// Encodes pixels as an 8-bit PNG; values are clamped to 0..1.
/// @throws InputError if the image is empty or too large
std::vector<unsigned char> encode_png(std::span<const float> pixels, std::size_t height,
                                      std::size_t width, std::size_t channels);

/// Writes .png (8 bit, values clamped to 0..1) or .exr (32-bit float, ZIP) atomically (see
/// io/new_file.hpp).
/// @param names channel names of an EXR, one per channel; empty: R, G, B...
/// @throws InputError if the file cannot be written
void write_image(const std::filesystem::path& path, std::span<const float> pixels,
                 std::size_t height, std::size_t width, std::size_t channels,
                 const io::Metadata& metadata, const std::vector<std::string>& names = {});

} // namespace firetwin::sensor
