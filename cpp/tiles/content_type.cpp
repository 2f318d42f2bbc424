#include "tiles/content_type.hpp"

#include "tiles/json.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <optional>
#include <string_view>
#include <utility>

namespace firetwin::tiles {
namespace {

constexpr std::array<std::pair<std::string_view, ContentType>, 6> magics = {{
    {"b3dm", ContentType::b3dm},
    {"i3dm", ContentType::i3dm},
    {"cmpt", ContentType::cmpt},
    {"pnts", ContentType::pnts},
    {"glTF", ContentType::glb},
    {"subt", ContentType::subtree},
}};

/// JSON may start with a byte order mark and white space.
bool looks_like_json(Bytes content) {
  constexpr std::array<std::uint8_t, 3> mark = {0xEF, 0xBB, 0xBF};
  if (content.size() >= 3 && std::equal(mark.begin(), mark.end(), content.begin())) {
    content = content.subspan(3);
  }
  const auto first = std::find_if_not(content.begin(), content.end(),
                                      [](std::uint8_t c) { return std::isspace(c) != 0; });
  return first != content.end() && *first == '{';
}

ContentType detect_json_type(Bytes content, const std::string& name) {
  const Node root = parse_json(content, name);
  return root.find("root") ? ContentType::tileset : ContentType::gltf;
}

std::string first_bytes(Bytes content) {
  std::string shown;
  for (const std::uint8_t byte : content.first(std::min<std::size_t>(content.size(), 4))) {
    std::array<char, 4> hex{};
    std::snprintf(hex.data(), hex.size(), "%02x ", byte);
    shown += hex.data();
  }
  return shown.empty() ? "nothing" : shown.substr(0, shown.size() - 1);
}

} // namespace

ContentType detect_content_type(Bytes content, const std::string& name) {
  const std::string_view start(reinterpret_cast<const char*>(content.data()),
                               std::min<std::size_t>(content.size(), 4));
  for (const auto& [magic, type] : magics) {
    if (start == magic) {
      return type;
    }
  }
  if (!looks_like_json(content)) {
    refuse(name, "is not 3D Tiles content: it begins with " + first_bytes(content) +
                     " instead of b3dm, i3dm, cmpt, pnts, glTF or JSON");
  }
  return detect_json_type(content, name);
}

const char* name_of(ContentType type) {
  switch (type) {
  case ContentType::gltf:
    return "gltf";
  case ContentType::glb:
    return "glb";
  case ContentType::tileset:
    return "tileset";
  case ContentType::subtree:
    return "subtree";
  default:
    break;
  }
  for (const auto& [magic, each] : magics) {
    if (each == type) {
      return magic.data();
    }
  }
  return "";
}

} // namespace firetwin::tiles
