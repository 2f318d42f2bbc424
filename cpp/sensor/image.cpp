#include "sensor/image.hpp"

#include "io/file.hpp"
#include "io/name.hpp"
#include "io/new_file.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <ostream>
#include <stdexcept>
#include <string_view>

namespace firetwin::sensor {
namespace {

constexpr int largest_megabytes = 1024;
constexpr int most_channels = 64;
// PNG files are 4 times as quick to write as with zlib's usual level 6 and no filter, and an eighth
// larger.
constexpr int png_level = 1;     // of zlib
constexpr int png_filter = 0x10; // of libpng: differences from the pixel at the left
constexpr OIIO::imagesize_t most_values = 256'000'000; // 1 GB of floats

/// OpenImageIO's name of a format, by the first bytes.
std::string format_of(const std::filesystem::path& path) {
  using namespace std::string_view_literals;
  const io::File file(path);
  std::array<char, 8> start{};
  const std::size_t have = std::min<std::uint64_t>(file.size(), start.size());
  file.read(0, std::span(start).first(have));
  const std::string_view bytes(start.data(), have);
  if (bytes == "\x89PNG\r\n\x1a\n"sv) {
    return "png";
  }
  if (bytes.starts_with("\x76\x2f\x31\x01"sv)) {
    return "openexr";
  }
  if (bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv)) {
    return "tiff";
  }
  if (bytes.starts_with("\xff\xd8\xff"sv)) {
    return "jpeg";
  }
  io::fail(path, "is not a PNG, OpenEXR, TIFF or JPEG image");
}

void set_limits() {
  static std::once_flag once;
  std::call_once(once, [] {
    OIIO::attribute("limits:imagesize_MB", largest_megabytes);
    OIIO::attribute("limits:channels", most_channels);
  });
}

OIIO::ImageSpec make_spec(std::size_t height, std::size_t width, std::size_t channels, bool exr,
                          const io::Metadata& metadata, const std::vector<std::string>& names) {
  OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height),
                       static_cast<int>(channels),
                       exr ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
  if (exr) {
    spec.attribute("compression", "zip");
    spec.attribute("DateTime",
                   "1970:01:01 00:00:00"); // else now: one picture would have many files
  }
  if (!exr) {
    spec.attribute("png:compressionLevel", png_level);
    spec.attribute("png:filter", png_filter);
  }
  if (exr && !names.empty()) {
    spec.channelnames = names;
  }
  for (const auto& [key, value] : metadata) {
    spec.attribute(key, value);
  }
  return spec;
}

void check_size(const std::filesystem::path& path, std::size_t height, std::size_t width,
                std::size_t channels) {
  constexpr std::size_t longest = 1U << 20;
  if (height == 0 || width == 0 || channels == 0 || height > longest || width > longest ||
      channels > most_channels) {
    io::fail(path, "an image needs at least one pixel and at most 64 channels");
  }
}

/// What a header claims, before memory is given to it (OpenImageIO 2.4 checks only some formats).
void check_spec(const std::filesystem::path& path, const OIIO::ImageSpec& spec) {
  if (spec.deep || spec.depth > 1) {
    io::fail(path, "is a deep or volume image; write it flat");
  }
  if (spec.nchannels < 1 || spec.nchannels > most_channels ||
      spec.image_pixels() > most_values / static_cast<unsigned>(spec.nchannels)) {
    io::fail(path, "has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                       " pixels of " + std::to_string(spec.nchannels) +
                       " channels; the limit is 256 million values and 64 channels");
  }
}

std::vector<unsigned char> encode(const std::filesystem::path& path, std::span<const float> pixels,
                                  const OIIO::ImageSpec& spec, bool exr) {
  set_limits();
  OIIO::Filesystem::IOVecOutput memory;
  const auto output = OIIO::ImageOutput::create(exr ? "openexr" : "png");
  if (!output || !output->set_ioproxy(&memory) ||
      !output->open(exr ? "memory.exr" : "memory.png", spec) ||
      !output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) || !output->close()) {
    io::fail(path, "cannot be written: " + (output ? output->geterror() : OIIO::geterror()));
  }
  return memory.buffer();
}

} // namespace

Image read_image(const std::filesystem::path& path) {
  set_limits();
  const auto input = OIIO::ImageInput::create(format_of(path));
  OIIO::ImageSpec spec;
  if (!input || !input->open(io::utf8(path), spec)) {
    io::fail(path, "cannot be read: " + (input ? input->geterror() : OIIO::geterror()));
  }
  check_spec(path, spec);
  Image image{static_cast<std::size_t>(spec.height),
              static_cast<std::size_t>(spec.width),
              static_cast<std::size_t>(spec.nchannels),
              {},
              spec.channelnames};
  image.pixels.resize(image.height * image.width * image.channels);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.pixels.data())) {
    io::fail(path, "cannot be read: " + input->geterror());
  }
  return image;
}

void write_image(const std::filesystem::path& path, std::span<const float> pixels,
                 std::size_t height, std::size_t width, std::size_t channels,
                 const io::Metadata& metadata, const std::vector<std::string>& names) {
  const bool exr = path.extension() == ".exr";
  if (!exr && path.extension() != ".png") {
    io::fail(path, "an image file must end in .png or .exr");
  }
  check_size(path, height, width, channels);
  if (!names.empty() && names.size() != channels) {
    throw std::invalid_argument("names must be as many as there are channels");
  }
  // Into memory first: OpenImageIO does not say when the end of an EXR finds no room on the disk.
  const std::vector<unsigned char> bytes =
      encode(path, pixels, make_spec(height, width, channels, exr, metadata, names), exr);
  io::write_file(path, [&bytes](std::ostream& stream) {
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
  });
}

} // namespace firetwin::sensor
