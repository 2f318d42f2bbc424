#include "tiles/container.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace firetwin::tiles {
namespace {

constexpr std::uint32_t json_chunk = 0x4E4F534A;   ///< "JSON"
constexpr std::uint32_t binary_chunk = 0x004E4942; ///< "BIN\0"

/// Extensions that are read or do not affect the parts that are read.
constexpr std::array<std::string_view, 13> known = {
    "KHR_draco_mesh_compression",
    "KHR_mesh_quantization",
    "EXT_meshopt_compression",
    "EXT_mesh_gpu_instancing",
    "KHR_texture_transform",
    "EXT_texture_webp",
    "CESIUM_RTC",
    "KHR_materials_unlit",
    "KHR_materials_pbrSpecularGlossiness",
    "EXT_mesh_features",
    "EXT_instance_features",
    "EXT_structural_metadata",
    "CESIUM_primitive_outline",
};

std::string remedy(std::string_view extension) {
  if (extension == "KHR_texture_basisu") {
    return "KTX2 textures are not supported; convert them to JPEG, PNG or WebP "
           "(gltf-transform does)";
  }
  if (extension == "KHR_techniques_webgl") {
    return "shader materials are not supported; convert them to glTF 2.0 materials";
  }
  return "unknown extension; convert the content without it";
}

void check_version(const Node& root) {
  const std::string version = root.at("asset").text("version", "");
  if (version.rfind("2.", 0) != 0) {
    root.at("asset").refuse("is glTF " + (version.empty() ? "without a version" : version) +
                            "; only version 2.0 is supported");
  }
}

void check_extensions(const Node& root) {
  for (const Node& required : root.elements("extensionsRequired")) {
    const std::string extension = required.text();
    if (std::find(known.begin(), known.end(), extension) == known.end()) {
      required.refuse("requires " + extension + ": " + remedy(extension));
    }
  }
}

struct Chunks {
  Bytes json;
  std::optional<Bytes> binary;
};

Bytes trim_to_length(Bytes content, const std::string& name) {
  if (content.size() < 20) {
    refuse(name, "is truncated: a glb has at least 20 bytes");
  }
  const auto version = load<std::uint32_t>(content.data() + 4);
  if (version != 2) {
    refuse(name, "is glb version " + std::to_string(version) + "; only version 2 is supported");
  }
  const std::size_t length = load<std::uint32_t>(content.data() + 8);
  if (length > content.size() || length < 20) {
    refuse(name, "is truncated: its glb header declares " + std::to_string(length) +
                     " bytes, but the content has " + std::to_string(content.size()));
  }
  return content.first(length);
}

Chunks split(Bytes content, const std::string& name) {
  Bytes rest = trim_to_length(content, name).subspan(12);
  Chunks chunks;
  for (std::size_t i = 0; rest.size() >= 8; ++i) {
    const std::size_t length = load<std::uint32_t>(rest.data());
    const auto type = load<std::uint32_t>(rest.data() + 4);
    rest = rest.subspan(8);
    if (length > rest.size()) {
      refuse(name, "a chunk of its glb has " + std::to_string(length) + " bytes, but only " +
                       std::to_string(rest.size()) + " are left");
    }
    if (i == 0 && type != json_chunk) {
      refuse(name, "the first chunk of its glb is not JSON");
    }
    if (i == 0) {
      chunks.json = rest.first(length);
    } else if (i == 1 && type == binary_chunk) {
      chunks.binary = rest.first(length);
    }
    rest = rest.subspan(length);
  }
  return chunks;
}

Bytes without_mark(Bytes text) {
  constexpr std::array<std::uint8_t, 3> mark = {0xEF, 0xBB, 0xBF};
  const bool marked = text.size() >= 3 && std::equal(mark.begin(), mark.end(), text.begin());
  return marked ? text.subspan(3) : text;
}

} // namespace

Container open_gltf(Bytes content, const std::string& name) {
  static constexpr std::array<std::uint8_t, 4> magic = {'g', 'l', 'T', 'F'};
  const bool is_glb =
      content.size() >= 4 && std::equal(magic.begin(), magic.end(), content.begin());
  const Chunks chunks = is_glb ? split(content, name) : Chunks{without_mark(content), std::nullopt};
  Container opened{parse_json(chunks.json, name), chunks.binary};
  check_version(opened.root);
  check_extensions(opened.root);
  return opened;
}

} // namespace firetwin::tiles
