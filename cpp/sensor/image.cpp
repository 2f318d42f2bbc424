#include "sensor/image.hpp"

#include "base/error.hpp"
#include "io/file.hpp"
#include "io/name.hpp"
#include "io/new_file.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

namespace firetwin::sensor {
namespace {

[[noreturn]] void fail(const std::string& name, const std::string& reason) {
  throw InputError(name, 0, 0, reason);
}

constexpr int max_megabytes = 1024;
constexpr int max_channels = 64;
constexpr OIIO::imagesize_t max_values = 256'000'000; // 1 GB of floats
// Writing a PNG is 4 times faster than with zlib's default level 6 and no filter; the file is an
// eighth larger.
constexpr int png_level = 1;     // zlib compression level
constexpr int png_filter = 0x10; // libpng's PNG_FILTER_SUB: difference from the pixel to the left
constexpr std::size_t magic_length = 8;

/// Encoded image in memory. IOMemReader of OpenImageIO 2.4 adds an offset and a size without a
/// check for overflow: a negative offset, which an EXR may contain, reads memory in front of the
/// buffer.
class MemoryReader : public OIIO::Filesystem::IOMemReader {
public:
  using IOMemReader::IOMemReader;
  std::size_t pread(void* buffer, std::size_t size, std::int64_t offset) override {
    return offset < 0 ? 0 : IOMemReader::pread(buffer, size, offset);
  }
};

/// OpenImageIO's name of the format with these magic bytes.
std::string detect_format(std::string_view magic, const std::string& name) {
  using namespace std::string_view_literals;
  if (magic == "\x89PNG\r\n\x1a\n"sv) {
    return "png";
  }
  if (magic.starts_with("\x76\x2f\x31\x01"sv)) {
    return "openexr";
  }
  if (magic.starts_with("II*\0"sv) || magic.starts_with("MM\0*"sv)) {
    return "tiff";
  }
  if (magic.starts_with("\xff\xd8\xff"sv)) {
    return "jpeg";
  }
  fail(name, "is not a PNG, OpenEXR, TIFF or JPEG image");
}

std::string detect_format(const std::filesystem::path& path) {
  const io::File file(path);
  std::array<char, magic_length> start{};
  const std::size_t length = std::min<std::uint64_t>(file.size(), start.size());
  file.read(0, std::span(start).first(length));
  return detect_format({start.data(), length}, io::utf8(path));
}

void set_limits() {
  [[maybe_unused]] static const bool size = OIIO::attribute("limits:imagesize_MB", max_megabytes);
  [[maybe_unused]] static const bool channels = OIIO::attribute("limits:channels", max_channels);
}

constexpr float half_max = 65504.0F;

/// OpenImageIO's names of attributes that it does not pass on by their names in OpenEXR.
constexpr std::array<std::pair<std::string_view, const char*>, 5> oiio_names{{
    {"capDate", "DateTime"},
    {"comments", "ImageDescription"},
    {"owner", "Copyright"},
    {"timeCode", "smpte:TimeCode"},
    {"worldToCamera", "worldtocamera"},
}};

/// Bits of OpenEXR's TV60 packing: binary-coded decimals, and flags.
std::array<std::uint32_t, 2> pack(const TimeCode& code) {
  const auto decimal = [](unsigned value) { return value / 10 * 16 + value % 10; };
  return {decimal(code.frame) | (code.drop_frame ? 1U << 6U : 0U) | decimal(code.seconds) << 8U |
              (code.second_field ? 1U << 15U : 0U) | decimal(code.minutes) << 16U |
              decimal(code.hours) << 24U,
          0U};
}

void set_attribute(OIIO::ImageSpec& spec, const std::string& key, const Attribute& value) {
  using OIIO::TypeDesc;
  const auto* const known = std::find_if(oiio_names.begin(), oiio_names.end(),
                                         [&key](const auto& each) { return each.first == key; });
  const std::string name = known != oiio_names.end() ? known->second : key;
  const auto set = [&]<class T>(const T& typed) {
    if constexpr (std::is_same_v<T, Rational>) {
      const std::array<std::int32_t, 2> both{typed.numerator,
                                             static_cast<std::int32_t>(typed.denominator)};
      spec.attribute(name, OIIO::TypeRational, both.data());
    } else if constexpr (std::is_same_v<T, TimeCode>) {
      spec.attribute(name, OIIO::TypeTimeCode, pack(typed).data());
    } else if constexpr (std::is_same_v<T, std::array<float, 2>>) {
      spec.attribute(name, TypeDesc(TypeDesc::FLOAT, TypeDesc::VEC2), typed.data());
    } else if constexpr (std::is_same_v<T, std::array<float, 3>>) {
      spec.attribute(name, TypeDesc(TypeDesc::FLOAT, TypeDesc::VEC3), typed.data());
    } else if constexpr (std::is_same_v<T, std::array<float, 16>>) {
      spec.attribute(name, OIIO::TypeMatrix, typed.data());
    } else {
      spec.attribute(name, typed);
    }
  };
  std::visit(set, value);
}

OIIO::ImageSpec make_spec(std::size_t height, std::size_t width, std::size_t channels,
                          OIIO::TypeDesc format, const Attributes& attributes) {
  OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height),
                       static_cast<int>(channels), format);
  for (const auto& [key, value] : attributes) {
    set_attribute(spec, key, value);
  }
  return spec;
}

OIIO::ImageSpec exr_spec(std::size_t height, std::size_t width, std::size_t channels,
                         const Attributes& attributes, const ExrStorage& storage) {
  OIIO::ImageSpec spec = make_spec(height, width, channels,
                                   storage.half ? OIIO::TypeHalf : OIIO::TypeFloat, attributes);
  if (!attributes.contains("capDate")) {
    // The default is the current time, which makes files of equal images differ.
    spec.attribute("DateTime", "1970:01:01 00:00:00");
  }
  spec.attribute("compression", storage.one_line ? "zips" : "zip");
  if (!storage.names.empty()) {
    spec.channelnames = storage.names;
  }
  return spec;
}

OIIO::ImageSpec png_spec(std::size_t height, std::size_t width, std::size_t channels,
                         const Attributes& attributes) {
  OIIO::ImageSpec spec = make_spec(height, width, channels, OIIO::TypeUInt8, attributes);
  spec.attribute("png:compressionLevel", png_level);
  spec.attribute("png:filter", png_filter);
  return spec;
}

/// Clamps finite values to the range of 16-bit floats; larger ones would become infinite.
std::vector<float> limited_to_half(std::span<const float> pixels) {
  std::vector<float> limited(pixels.begin(), pixels.end());
  for (float& value : limited) {
    if (std::isfinite(value)) {
      value = std::clamp(value, -half_max, half_max);
    }
  }
  return limited;
}

void check_size(const std::string& name, std::size_t height, std::size_t width,
                std::size_t channels) {
  constexpr std::size_t max_side = 1U << 20;
  if (height == 0 || width == 0 || channels == 0 || height > max_side || width > max_side ||
      channels > max_channels) {
    fail(name, "an image needs at least one pixel and at most 64 channels");
  }
}

/// Checks the size in a header before memory is allocated (OpenImageIO 2.4 checks some formats
/// only).
void check_spec(const std::string& name, const OIIO::ImageSpec& spec) {
  if (spec.deep || spec.depth > 1) {
    fail(name, "is a deep or volume image; save it as a flat image");
  }
  if (spec.nchannels < 1 || spec.nchannels > max_channels ||
      spec.image_pixels() > max_values / static_cast<unsigned>(spec.nchannels)) {
    fail(name, "has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                   " pixels and " + std::to_string(spec.nchannels) +
                   " channels; the limit is 256 million values and 64 channels");
  }
}

/// Reads a format from a file, or from `memory` if it is not null.
Image read(const std::string& format, const std::string& name,
           OIIO::Filesystem::IOProxy* memory = nullptr) {
  set_limits();
  const auto input = OIIO::ImageInput::create(format);
  OIIO::ImageSpec spec;
  if (!input || (memory != nullptr && !input->set_ioproxy(memory)) || !input->open(name, spec)) {
    fail(name, "cannot be read: " + (input ? input->geterror() : OIIO::geterror()));
  }
  check_spec(name, spec);
  Image image{static_cast<std::size_t>(spec.height),
              static_cast<std::size_t>(spec.width),
              static_cast<std::size_t>(spec.nchannels),
              {},
              spec.channelnames};
  image.pixels.resize(image.height * image.width * image.channels);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.pixels.data())) {
    fail(name, "cannot be read: " + input->geterror());
  }
  return image;
}

std::vector<unsigned char> encode(const std::string& name, std::span<const float> pixels,
                                  const OIIO::ImageSpec& spec, bool exr) {
  set_limits();
  OIIO::Filesystem::IOVecOutput memory;
  const auto output = OIIO::ImageOutput::create(exr ? "openexr" : "png");
  if (!output || !output->set_ioproxy(&memory) ||
      !output->open(exr ? "memory.exr" : "memory.png", spec) ||
      !output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) || !output->close()) {
    fail(name, "cannot be written: " + (output ? output->geterror() : OIIO::geterror()));
  }
  return memory.buffer();
}

} // namespace

Image read_image(const std::filesystem::path& path) {
  return read(detect_format(path), io::utf8(path));
}

Image decode_image(std::span<const unsigned char> data, const std::string& name) {
  const std::span magic = data.first(std::min(data.size(), magic_length));
  MemoryReader memory(data.data(), data.size());
  return read(detect_format({reinterpret_cast<const char*>(magic.data()), magic.size()}, name),
              name, &memory);
}

std::vector<unsigned char> encode_png(std::span<const float> pixels, std::size_t height,
                                      std::size_t width, std::size_t channels) {
  const std::string name = "PNG";
  check_size(name, height, width, channels);
  return encode(name, pixels, png_spec(height, width, channels, {}), false);
}

void write_image(const std::filesystem::path& path, std::span<const float> pixels,
                 std::size_t height, std::size_t width, std::size_t channels,
                 const Attributes& attributes, const ExrStorage& storage) {
  const bool exr = path.extension() == ".exr";
  if (!exr && path.extension() != ".png") {
    io::fail(path, "an image file must end in .png or .exr");
  }
  check_size(io::utf8(path), height, width, channels);
  if (!storage.names.empty() && storage.names.size() != channels) {
    throw std::invalid_argument("names must have one entry per channel");
  }
  const OIIO::ImageSpec spec = exr ? exr_spec(height, width, channels, attributes, storage)
                                   : png_spec(height, width, channels, attributes);
  std::vector<float> limited;
  if (exr && storage.half) {
    limited = limited_to_half(pixels);
    pixels = limited;
  }
  // Encoded in memory: OpenImageIO does not report a full disk while it writes the end of an EXR.
  const std::vector<unsigned char> bytes = encode(io::utf8(path), pixels, spec, exr);
  io::write_file(path, [&bytes](std::ostream& stream) {
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
  });
}

} // namespace firetwin::sensor
