#pragma once

#include "tiles/matrix.hpp"
#include "tiles/tile.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace firetwin::tiles {

/// Vertices in the content's local frame; all are finite.
struct Primitive {
  std::vector<float> position;         ///< n x 3
  std::vector<float> normal;           ///< n x 3; empty for points without normals
  std::vector<float> uv;               ///< n x 2, or empty
  std::vector<float> colour;           ///< n x 4, linear, or empty
  std::vector<std::uint32_t> triangle; ///< m x 3
  int material = -1;
  bool points = false;
  bool has_normals = false;

  std::size_t vertices() const { return position.size() / 3; }
};

/// Collects the primitives of a tile's contents and merges them in the scene's frame.
class Assembler {
public:
  explicit Assembler(std::string name) : name_(std::move(name)) {}

  int add_image(Image image);
  int add_material(Material material);
  void add_copyright(std::string_view text); ///< adds each notice between semicolons once
  void add_lines() { ++tile_.lines; }
  void add_not_finite(std::size_t vertices) { tile_.not_finite += vertices; }
  /// Adds an instance of a primitive. A singular matrix hides it, as in glTF.
  /// @throws InputError if the tile exceeds max_instances or max_vertices
  void add_draw(std::shared_ptr<const Primitive> primitive, const Matrix& to_scene);
  /// Counts decoded memory. @throws InputError beyond max_decoded_bytes
  void reserve_bytes(std::size_t bytes);
  Tile finish();

private:
  struct Draw {
    std::shared_ptr<const Primitive> primitive;
    Matrix to_scene;
  };
  struct Bounds {
    Vector low, high;
    double spacing; ///< m between neighbouring float32 numbers in the content's coordinates
  };

  static Bounds bounds(const Draw& draw);
  void choose_origin();
  void append(const Draw& draw, bool coloured);
  void append_vertices(const Draw& draw, bool coloured);

  std::string name_;
  Tile tile_;
  std::vector<Draw> draws_;
  std::vector<std::string> notices_;
  std::size_t instances_ = 0;
  std::size_t vertices_ = 0;
  std::size_t bytes_ = 0;
};

} // namespace firetwin::tiles
