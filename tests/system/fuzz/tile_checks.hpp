#pragma once

#include "check.hpp"
#include "tiles/content_type.hpp"
#include "tiles/decode.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

/// Shared by the fuzzers of 3D Tiles: content is assembled from parts of an input, so that its
/// lengths are right, and decoded arrays must satisfy their invariants.
namespace firetwin::fuzz {

/// The first lines of an input, and the rest as the last.
template <std::size_t n> std::array<std::string, n> parts(std::string_view input) {
  std::array<std::string, n> found;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t end = i + 1 < n ? std::min(input.find('\n'), input.size()) : input.size();
    found[i] = input.substr(0, end);
    input.remove_prefix(std::min(end + 1, input.size()));
  }
  return found;
}

inline std::string word(std::size_t value) {
  std::string bytes(4, '\0');
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[i] = static_cast<char>(value >> (8 * i) & 0xFFU);
  }
  return bytes;
}

inline std::string glb(const std::string& json, const std::string& binary) {
  return "glTF" + word(2) + word(28 + json.size() + binary.size()) + word(json.size()) + "JSON" +
         json + word(binary.size()) + std::string("BIN\0", 4) + binary;
}

/// A b3dm, i3dm or pnts; `extra` follows the lengths of the tables.
inline std::string with_tables(const std::string& magic, const std::string& json,
                               const std::string& binary, const std::string& body,
                               const std::string& extra = "") {
  const std::size_t size = 28 + extra.size() + json.size() + binary.size() + body.size();
  return magic + word(1) + word(size) + word(json.size()) + word(binary.size()) + word(0) +
         word(0) + extra + json + binary + body;
}

inline tiles::Bytes bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

inline void check_arrays(const tiles::Tile& tile) {
  const std::size_t n = tile.position.size() / 3;
  check(tile.position.size() == 3 * n && tile.normal.size() == 3 * n && tile.uv.size() == 2 * n,
        "arrays have a row for each vertex");
  check(tile.colour.empty() || tile.colour.size() == 4 * n, "colours too");
  for (const std::vector<float>* values : {&tile.position, &tile.normal, &tile.uv, &tile.colour}) {
    check(std::all_of(values->begin(), values->end(), [](float v) { return std::isfinite(v); }),
          "every number is finite");
  }
  check(tile.triangle.size() % 3 == 0, "triangles have three corners");
  check(std::all_of(tile.triangle.begin(), tile.triangle.end(),
                    [n](std::uint32_t i) { return i < n; }),
        "corners are vertices");
  check(std::all_of(tile.origin.begin(), tile.origin.end(),
                    [](double v) { return v == std::round(v); }),
        "an origin is of whole metres");
}

inline void check_ranges(const tiles::Tile& tile) {
  std::size_t vertex = 0, triangle = 0;
  for (const tiles::Range& range : tile.ranges) {
    check(range.first_vertex == vertex && range.first_triangle == triangle, "ranges have no gaps");
    check(range.material >= -1 && range.material < static_cast<int>(tile.materials.size()),
          "a range's material is there");
    check(range.points == (range.triangles == 0) && range.vertices > 0, "no range is empty");
    vertex += range.vertices;
    triangle += range.triangles;
  }
  check(3 * vertex == tile.position.size() && 3 * triangle == tile.triangle.size(),
        "ranges cover all");
  for (const tiles::Material& material : tile.materials) {
    check(material.image >= -1 && material.image < static_cast<int>(tile.images.size()),
          "a material's picture is there");
  }
  for (const tiles::Image& image : tile.images) {
    check(image.data.empty() != image.kind.size() > 0 && image.width <= 16384,
          "pictures are known");
  }
}

/// The resources that an input may name.
inline const tiles::Resources& resources() {
  static const std::string document =
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"a.bin"}]})";
  static const std::string binary("\0\0\x80\x3f\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\x80\x40\0\0\x80\x3f"
                                  "\0\0\0\0\0\0\x80\x3e\0\0\0\0",
                                  36);
  static const tiles::Resources known = {{"a.gltf", bytes(document)}, {"a.bin", bytes(binary)}};
  return known;
}

/// Decodes, and decodes again what ends before more bytes: the same, or as wrong.
inline void check_content(const std::string& content) {
  std::size_t vertices = 0;
  bool decoded = false;
  expect_result_or_input_error([&] {
    const tiles::Tile tile = tiles::decode(bytes(content), "tile", resources(), {});
    check_arrays(tile);
    check_ranges(tile);
    vertices = tile.position.size();
    decoded = true;
  });
  expect_result_or_input_error(
      [&] { tiles::list_missing_resources(bytes(content), "tile", resources()); });
  if (decoded && tiles::detect_content_type(bytes(content), "tile") != tiles::ContentType::gltf) {
    const std::string longer = content + "more";
    check(tiles::decode(bytes(longer), "tile", resources(), {}).position.size() == vertices,
          "content ends where its header says");
  }
}

} // namespace firetwin::fuzz
