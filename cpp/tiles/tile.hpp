#pragma once

#include "base/vector.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace firetwin::tiles {

/// An encoded picture, as it lies in the content or beside it.
struct Image {
  std::string kind;               ///< "jpeg", "png", "webp"; nothing when only the uri is known
  std::uint32_t width = 0;        ///< pixels, by its header
  std::uint32_t height = 0;       ///< pixels, by its header
  std::vector<std::uint8_t> data; ///< the file; nothing when only the uri is known
  std::string uri;                ///< relative to the content; nothing when the content holds it
};

struct Material {
  std::array<double, 4> colour = {1, 1, 1, 1}; ///< linear, times the picture's
  int image = -1;                              ///< index of the picture; -1 for none
  std::string wrap_u = "repeat";               ///< "repeat", "clamp" or "mirror"
  std::string wrap_v = "repeat";
  std::string alpha_mode = "opaque"; ///< "opaque", "mask" or "blend"
  double alpha_cutoff = 0.5;         ///< of "mask"
  bool double_sided = false;
};

/// Vertices and triangles of one material.
struct Range {
  int material = -1; ///< index; -1 for none
  std::size_t first_vertex = 0;
  std::size_t vertices = 0;
  std::size_t first_triangle = 0;
  std::size_t triangles = 0; ///< 0 for points
  bool points = false;
  bool has_normals = false; ///< whether the content has them; else they are made
};

/// Decoded content. Vertices lie about an origin of whole metres, so that float32 is enough.
struct Tile {
  Vector origin{};                     ///< m, in the scene's frame
  std::vector<float> position;         ///< n x 3, m from the origin
  std::vector<float> normal;           ///< n x 3, unit vectors; 0 for points without
  std::vector<float> uv;               ///< n x 2, v counted upward; 0 where there is none
  std::vector<float> colour;           ///< n x 4, linear; nothing when no vertex has one
  std::vector<std::uint32_t> triangle; ///< m x 3, counter-clockwise from outside
  std::vector<Range> ranges;
  std::vector<Material> materials;
  std::vector<Image> images;
  std::string copyright;
  double spacing = 0.0;       ///< m between neighbouring float32 numbers at the farthest vertex
  std::size_t not_finite = 0; ///< vertices left out: NaN, infinite or farther than 1e9 m
  std::size_t lines = 0;      ///< primitives of lines, which are left out
};

} // namespace firetwin::tiles
