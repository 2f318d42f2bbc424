#include "tiles/buffers.hpp"

#include "tiles/meshopt.hpp"

#include <array>
#include <string_view>
#include <utility>

namespace firetwin::tiles {
namespace {

constexpr std::uint8_t no_letter = 64;

/// The six bits of each base64 character (RFC 4648).
constexpr std::array<std::uint8_t, 256> base64_values = [] {
  std::array<std::uint8_t, 256> values{};
  values.fill(no_letter);
  constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < letters.size(); ++i) {
    values[static_cast<unsigned char>(letters[i])] = static_cast<std::uint8_t>(i);
  }
  return values;
}();

/// True for a placeholder buffer whose data is stored compressed in another buffer.
bool is_fallback(const Node& buffer) {
  const auto extension = buffer.extension("EXT_meshopt_compression");
  return extension && extension->boolean("fallback", false);
}

} // namespace

std::string resolve_uri(const std::string& folder, const std::string& uri) {
  const bool absolute = uri.rfind('/', 0) == 0 || uri.find("://") != std::string::npos;
  return absolute ? uri : folder + uri;
}

std::string folder_of(const std::string& uri) {
  const std::size_t slash = uri.substr(0, uri.find('?')).rfind('/');
  return slash == std::string::npos ? "" : uri.substr(0, slash + 1);
}

bool is_data_uri(const std::string& uri) {
  return uri.rfind("data:", 0) == 0;
}

std::vector<std::uint8_t> decode_data_uri(const Node& uri) {
  const std::string text = uri.text();
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos || text.substr(0, comma).find(";base64") == std::string::npos) {
    uri.refuse("must be base64 data");
  }
  std::vector<std::uint8_t> bytes;
  bytes.reserve((text.size() - comma) / 4 * 3);
  std::uint32_t bits = 0;
  unsigned held = 0;
  for (std::size_t i = comma + 1; i < text.size() && text[i] != '='; ++i) {
    const std::uint8_t value = base64_values[static_cast<unsigned char>(text[i])];
    if (value == no_letter) {
      uri.refuse("contains a character that is not base64");
    }
    bits = bits << 6U | value;
    held += 6;
    if (held >= 8) {
      held -= 8;
      bytes.push_back(static_cast<std::uint8_t>(bits >> held & 0xFFU));
    }
  }
  return bytes;
}

Buffers::Buffers(const Container& container, const Resources& resources, std::string folder,
                 ReserveBytes reserve_bytes)
    : buffers_(container.root.elements("buffers")), views_(container.root.elements("bufferViews")),
      binary_(container.binary), resources_(&resources), folder_(std::move(folder)),
      reserve_bytes_(std::move(reserve_bytes)) {}

Bytes Buffers::buffer(const Node& index) {
  const std::size_t i = index.index(buffers_.size());
  const Node& node = buffers_[i];
  const std::size_t length = node.at("byteLength").integer();
  const auto uri = node.find("uri");
  Bytes bytes;
  if (!uri && i == 0 && binary_) {
    bytes = *binary_;
  } else if (!uri) {
    node.refuse("has no uri, and the content has no binary chunk for it");
  } else if (is_data_uri(uri->text())) {
    if (!decoded_buffers_.contains(i)) {
      reserve_bytes_(uri->text().size());
      decoded_buffers_[i] = decode_data_uri(*uri);
    }
    bytes = decoded_buffers_[i];
  } else {
    const auto found = resources_->find(resolve_uri(folder_, uri->text()));
    if (found == resources_->end()) {
      uri->refuse("the file " + uri->text() + " is not among the resources");
    }
    bytes = found->second;
  }
  if (bytes.size() < length) {
    node.refuse("declares " + std::to_string(length) + " bytes, but has " +
                std::to_string(bytes.size()));
  }
  return bytes.first(length);
}

/// The part of a buffer given by byteOffset and byteLength of a view or of its compressed form.
Bytes Buffers::slice(const Node& described) {
  const Bytes bytes = buffer(described.at("buffer"));
  const std::size_t offset = described.integer("byteOffset", 0);
  const std::size_t length = described.at("byteLength").integer();
  if (!within(offset, length, bytes.size())) {
    described.refuse("ends at byte " + std::to_string(offset + length) + " of a buffer of " +
                     std::to_string(bytes.size()));
  }
  return bytes.subspan(offset, length);
}

Bytes Buffers::decompressed(std::size_t index, const Node& view, const Node& extension) {
  const auto found = decoded_views_.find(index);
  if (found != decoded_views_.end()) {
    return found->second;
  }
  const MeshoptView description = read_meshopt(extension);
  const std::size_t size = description.count * description.stride;
  if (size != view.at("byteLength").integer()) {
    extension.refuse("has " + std::to_string(size) +
                     " bytes when decompressed, but the view declares " +
                     std::to_string(view.at("byteLength").integer()));
  }
  const Bytes compressed = slice(extension);
  reserve_bytes_(size);
  return decoded_views_.emplace(index, decompress_meshopt(description, compressed, extension))
      .first->second;
}

Buffers::View Buffers::view(const Node& index) {
  const std::size_t i = index.index(views_.size());
  const Node& node = views_[i];
  const std::size_t stride = node.integer("byteStride", 0);
  if (stride > 256) {
    node.at("byteStride").refuse("is " + std::to_string(stride) + "; the limit is 256");
  }
  const auto extension = node.extension("EXT_meshopt_compression");
  return {extension ? decompressed(i, node, *extension) : slice(node), stride};
}

std::vector<std::string> Buffers::missing_uris() const {
  std::vector<std::string> uris;
  for (const Node& buffer : buffers_) {
    const auto uri = buffer.find("uri");
    if (!uri || is_data_uri(uri->text()) || is_fallback(buffer)) {
      continue;
    }
    std::string place = resolve_uri(folder_, uri->text());
    if (!resources_->contains(place)) {
      uris.push_back(std::move(place));
    }
  }
  return uris;
}

} // namespace firetwin::tiles
