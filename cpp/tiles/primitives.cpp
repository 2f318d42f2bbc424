#include "tiles/primitives.hpp"

#include "tiles/draco.hpp"
#include "tiles/limits.hpp"
#include "tiles/triangles.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace firetwin::tiles {
namespace {

constexpr std::size_t mode_points = 0, mode_triangles = 4, mode_fan = 6;

/// Attributes of one primitive, plain or Draco-compressed.
class Attributes {
public:
  Attributes(const Node& primitive, const Reader& reader)
      : primitive_(primitive), named_(primitive.at("attributes")), reader_(reader) {
    if (named_.find("POSITION")) {
      vertices_ = reader.accessors.type(named_.at("POSITION")).count;
      decompress();
    }
  }

  bool has(const std::string& name) const { return named_.find(name).has_value(); }
  std::size_t vertices() const { return vertices_; }

  std::size_t components(const std::string& name) const {
    return reader_.accessors.type(named_.at(name)).components;
  }

  /// vertices() x components
  std::vector<float> floats(const std::string& name, std::size_t components) const {
    const Node index = named_.at(name);
    const AccessorType type = reader_.accessors.type(index);
    if (type.count != vertices_ || type.components != components) {
      index.refuse("names " + std::to_string(type.count) + " x " + std::to_string(type.components) +
                   " numbers instead of " + std::to_string(vertices_) + " x " +
                   std::to_string(components));
    }
    const auto id = draco_ ? compressed_->at("attributes").find(name) : std::nullopt;
    if (!id) {
      return reader_.accessors.floats(index);
    }
    reader_.assembler.reserve_bytes(vertices_ * components * sizeof(float));
    return draco_->floats(*id, components, type.normalized);
  }

  std::vector<std::uint32_t> corners() const {
    std::vector<std::uint32_t> corners;
    if (draco_) {
      corners = draco_->triangles();
    } else if (const auto indices = primitive_.find("indices")) {
      corners = reader_.accessors.indices(*indices);
    } else {
      corners.resize(vertices_);
      std::iota(corners.begin(), corners.end(), 0U);
    }
    if (!corners.empty() && *std::max_element(corners.begin(), corners.end()) >= vertices_) {
      primitive_.refuse("its indices exceed the number of vertices");
    }
    return corners;
  }

private:
  void decompress() {
    compressed_ = primitive_.extension("KHR_draco_mesh_compression");
    if (!compressed_) {
      return;
    }
    const std::size_t corners = reader_.accessors.type(primitive_.at("indices")).count;
    if (primitive_.integer("mode", mode_triangles) != mode_triangles || corners % 3 != 0) {
      compressed_->refuse("must have triangles");
    }
    reader_.assembler.reserve_bytes(4 * corners);
    const Bytes data = reader_.buffers.view(compressed_->at("bufferView")).bytes;
    draco_ = DracoData::mesh(data, vertices_, corners / 3, *compressed_);
  }

  Node primitive_;
  Node named_;
  const Reader& reader_;
  std::optional<Node> compressed_;
  std::optional<DracoData> draco_;
  std::size_t vertices_ = 0;
};

/// Copies the rows `kept` of an array with `components` columns.
std::vector<float> gather(const std::vector<float>& values, const std::vector<std::uint32_t>& kept,
                          std::size_t components) {
  std::vector<float> gathered;
  if (values.empty()) {
    return gathered;
  }
  gathered.reserve(kept.size() * components);
  for (const std::uint32_t i : kept) {
    const auto row = values.begin() + static_cast<std::ptrdiff_t>(i * components);
    gathered.insert(gathered.end(), row, row + static_cast<std::ptrdiff_t>(components));
  }
  return gathered;
}

bool is_finite(const std::vector<float>& position, std::size_t i) {
  return std::isfinite(position[3 * i]) && std::isfinite(position[3 * i + 1]) &&
         std::isfinite(position[3 * i + 2]);
}

/// Texture coordinates with v upward, transformed by KHR_texture_transform.
std::vector<float> read_uv(const Attributes& attributes, const MaterialUse& use) {
  const std::string name = "TEXCOORD_" + std::to_string(use.coordinates);
  if (!attributes.has(name)) {
    return {};
  }
  std::vector<float> uv = attributes.floats(name, 2);
  for (std::size_t i = 0; i < uv.size(); i += 2) {
    const auto u = static_cast<double>(uv[i]), v = static_cast<double>(uv[i + 1]);
    const auto& t = use.transform;
    const auto moved_u = static_cast<float>(t[0] * u + t[1] * v + t[2]);
    const auto moved_v = static_cast<float>(1.0 - (t[3] * u + t[4] * v + t[5]));
    const bool finite = std::isfinite(moved_u) && std::isfinite(moved_v);
    uv[i] = finite ? moved_u : 0.0F;
    uv[i + 1] = finite ? moved_v : 0.0F;
  }
  return uv;
}

/// n x 4; components that are not finite become 1.
std::vector<float> read_colour(const Attributes& attributes) {
  if (!attributes.has("COLOR_0")) {
    return {};
  }
  const std::size_t components = attributes.components("COLOR_0") == 3 ? 3 : 4;
  const std::vector<float> values = attributes.floats("COLOR_0", components);
  std::vector<float> colour(4 * attributes.vertices(), 1.0F);
  for (std::size_t i = 0; i < attributes.vertices(); ++i) {
    for (std::size_t c = 0; c < components; ++c) {
      const float value = values[components * i + c];
      colour[4 * i + c] = std::isfinite(value) ? value : 1.0F;
    }
  }
  return colour;
}

/// Returns the vertices to keep, in order: finite and used by a triangle. Renumbers the triangles.
std::vector<std::uint32_t> choose_vertices(Primitive& made, const std::vector<float>& position,
                                           std::vector<std::uint32_t> corners, std::size_t mode) {
  if (mode == mode_points) {
    std::erase_if(corners, [&](std::uint32_t i) { return !is_finite(position, i); });
    made.points = true;
    return corners;
  }
  made.triangle = list_triangles(std::move(corners), mode);
  drop_invalid_triangles(position, made.triangle);
  return compact_vertices(position.size() / 3, made.triangle);
}

void add_normals(Primitive& made, const Attributes& attributes,
                 const std::vector<std::uint32_t>& kept) {
  made.has_normals = attributes.has("NORMAL");
  if (made.has_normals) {
    made.normal = gather(attributes.floats("NORMAL", 3), kept, 3);
  } else if (!made.points) {
    made.normal = smooth_normals(made.position, made.triangle);
  }
}

std::shared_ptr<const Primitive> read_primitive(const Node& node, const Reader& reader) {
  const std::size_t mode = node.integer("mode", mode_triangles);
  if (mode > mode_fan) {
    node.at("mode").refuse("is " + std::to_string(mode) + ", which is not a glTF primitive mode");
  }
  if (mode > mode_points && mode < mode_triangles) {
    reader.assembler.add_lines();
    return nullptr;
  }
  const Attributes attributes(node, reader);
  if (!attributes.has("POSITION")) {
    return nullptr;
  }
  const std::vector<float> position = attributes.floats("POSITION", 3);
  std::size_t finite = 0;
  for (std::size_t i = 0; i < attributes.vertices(); ++i) {
    finite += is_finite(position, i) ? 1 : 0;
  }
  reader.assembler.add_not_finite(attributes.vertices() - finite);
  auto made = std::make_shared<Primitive>();
  const std::vector<std::uint32_t> kept =
      choose_vertices(*made, position, attributes.corners(), mode);
  if (kept.empty()) {
    return nullptr;
  }
  reader.assembler.reserve_bytes(kept.size() * 12 * sizeof(float));
  const auto material = node.find("material");
  const MaterialUse use = material ? reader.materials.use(*material) : MaterialUse{};
  made->material = use.material;
  made->position = gather(position, kept, 3);
  add_normals(*made, attributes, kept);
  made->uv = gather(read_uv(attributes, use), kept, 2);
  made->colour = gather(read_colour(attributes), kept, 4);
  return made;
}

} // namespace

std::vector<std::shared_ptr<const Primitive>> read_mesh(const Node& mesh, const Reader& reader) {
  std::vector<std::shared_ptr<const Primitive>> primitives;
  for (const Node& node : mesh.elements("primitives")) {
    if (auto made = read_primitive(node, reader)) {
      primitives.push_back(std::move(made));
    }
  }
  return primitives;
}

} // namespace firetwin::tiles
