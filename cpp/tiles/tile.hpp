#pragma once

#include "base/vector.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace firetwin::tiles {

/// An encoded image, embedded in the content or external.
struct Image {
  std::string kind;               ///< "jpeg", "png" or "webp"; empty if only the uri is known
  std::uint32_t width = 0;        ///< pixels, from the header
  std::uint32_t height = 0;       ///< pixels, from the header
  std::vector<std::uint8_t> data; ///< the encoded file; empty if only the uri is known
  std::string uri;                ///< relative to the content; empty if the image is embedded
};

struct Material {
  std::array<double, 4> colour = {1, 1, 1, 1}; ///< linear factor of the image's colour
  int image = -1;                              ///< index of the image; -1 for none
  std::string wrap_u = "repeat";               ///< "repeat", "clamp" or "mirror"
  std::string wrap_v = "repeat";
  std::string alpha_mode = "opaque"; ///< "opaque", "mask" or "blend"
  double alpha_cutoff = 0.5;         ///< for "mask"
  bool double_sided = false;
};

/// Range of vertices and triangles with one material.
struct Range {
  int material = -1; ///< index; -1 for none
  std::size_t first_vertex = 0;
  std::size_t vertices = 0;
  std::size_t first_triangle = 0;
  std::size_t triangles = 0; ///< 0 for points
  bool points = false;
  bool has_normals = false; ///< false if the normals are computed
};

/// Decoded content. Vertices are relative to an origin rounded to metres, so that float32 suffices.
struct Tile {
  Vector origin{};                     ///< m, in the scene's frame
  std::vector<float> position;         ///< n x 3, m from the origin
  std::vector<float> normal;           ///< n x 3, unit vectors; 0 for points without normals
  std::vector<float> uv;               ///< n x 2, v points up; 0 without texture coordinates
  std::vector<float> colour;           ///< n x 4, linear; empty if no vertex has a colour
  std::vector<std::uint32_t> triangle; ///< m x 3, counter-clockwise from outside
  std::vector<Range> ranges;
  std::vector<Material> materials;
  std::vector<Image> images;
  std::string copyright;
  double spacing = 0.0;       ///< m between neighbouring float32 numbers at the farthest vertex
  std::size_t not_finite = 0; ///< dropped vertices: NaN, infinite or farther than 1e9 m
  std::size_t lines = 0;      ///< dropped line primitives
};

} // namespace firetwin::tiles
