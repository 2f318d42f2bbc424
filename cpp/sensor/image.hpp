#pragma once

#include "sensor/attribute.hpp"

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

/// Storage of an EXR.
struct ExrStorage {
  std::vector<std::string> names; ///< of channels, one per channel; empty: R, G, B...
  bool half = false;              ///< 16-bit floats, with values limited to +-65504; else 32-bit
  bool one_line = false;          ///< ZIPS (blocks of one line), else ZIP (blocks of 16 lines)
};

/// Writes .png (8 bit, values clamped to 0..1) or .exr (scan lines, lossless) atomically (see
/// io/new_file.hpp).
/// @param attributes of the header; a PNG keeps texts only
/// @throws InputError if the file cannot be written
void write_image(const std::filesystem::path& path, std::span<const float> pixels,
                 std::size_t height, std::size_t width, std::size_t channels,
                 const Attributes& attributes, const ExrStorage& storage = {});

} // namespace firetwin::sensor
