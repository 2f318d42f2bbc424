#include "tiles/nodes.hpp"

#include "tiles/limits.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace firetwin::tiles {
namespace {

Matrix local_matrix(const Node& node) {
  if (const auto matrix = node.find("matrix")) {
    Matrix m = transpose(matrix->numbers<16>());
    for (std::size_t i = 0; i < 4; ++i) { // exporters compute in float32
      if (std::abs(m[12 + i] - identity[12 + i]) > 1e-5) {
        matrix->refuse("must be affine: its last row is not 0 0 0 1");
      }
      m[12 + i] = identity[12 + i];
    }
    return m;
  }
  const auto translation = node.find("translation"), rotation = node.find("rotation"),
             scale = node.find("scale");
  return from_parts(translation ? translation->numbers<3>() : Vector{0, 0, 0},
                    rotation ? rotation->numbers<4>() : std::array<double, 4>{0, 0, 0, 1},
                    scale ? scale->numbers<3>() : Vector{1, 1, 1});
}

/// Reads an attribute of EXT_mesh_gpu_instancing; empty if it is absent.
std::vector<float> read_instances(const Node& attributes, const char* name, std::size_t components,
                                  std::optional<std::size_t>& count, Accessors& accessors) {
  const auto index = attributes.find(name);
  if (!index) {
    return {};
  }
  const AccessorType type = accessors.type(*index);
  if (type.components != components || (count && *count != type.count)) {
    index->refuse("has another type or count than the other attributes");
  }
  if (type.count > max_instances) {
    index->refuse("has " + std::to_string(type.count) + " instances; the limit is " +
                  std::to_string(max_instances));
  }
  count = type.count;
  return accessors.floats(*index);
}

template <std::size_t n>
std::array<double, n> row(const std::vector<float>& values, std::size_t i,
                          const std::array<double, n>& absent) {
  std::array<double, n> found = absent;
  for (std::size_t c = 0; c < n && !values.empty(); ++c) {
    found[c] = static_cast<double>(values[n * i + c]);
  }
  return found;
}

/// Instance matrices of a node; only the identity if it has no instances.
std::vector<Matrix> instances_of(const Node& node, Accessors& accessors) {
  const auto extension = node.extension("EXT_mesh_gpu_instancing");
  if (!extension) {
    return {identity};
  }
  const Node attributes = extension->at("attributes");
  std::optional<std::size_t> count;
  const auto by = read_instances(attributes, "TRANSLATION", 3, count, accessors);
  const auto rotation = read_instances(attributes, "ROTATION", 4, count, accessors);
  const auto scale = read_instances(attributes, "SCALE", 3, count, accessors);
  std::vector<Matrix> matrices;
  for (std::size_t i = 0; i < count.value_or(0); ++i) {
    matrices.push_back(from_parts(row<3>(by, i, {0, 0, 0}), row<4>(rotation, i, {0, 0, 0, 1}),
                                  row<3>(scale, i, {1, 1, 1})));
  }
  return matrices;
}

/// Depth-first traversal of the nodes of one document.
class SceneTraversal {
public:
  SceneTraversal(const Node& root, const std::vector<Matrix>& to_scene, const Reader& reader)
      : nodes_(root.elements("nodes")), meshes_(root.elements("meshes")), to_scene_(to_scene),
        reader_(reader), seen_(nodes_.size(), false) {}

  void draw(const Node& index) {
    pending_.emplace_back(enter(index), identity);
    while (!pending_.empty()) {
      const auto [i, parent] = pending_.back();
      pending_.pop_back();
      const Matrix matrix = multiply(parent, local_matrix(nodes_[i]));
      if (const auto mesh = nodes_[i].find("mesh")) {
        draw_mesh(*mesh, nodes_[i], matrix);
      }
      for (const Node& child : nodes_[i].elements("children")) {
        pending_.emplace_back(enter(child), matrix);
      }
    }
  }

private:
  std::size_t enter(const Node& index) {
    const std::size_t i = index.index(nodes_.size());
    if (seen_[i]) {
      index.refuse("node " + std::to_string(i) + " is reached twice");
    }
    seen_[i] = true;
    return i;
  }

  const std::vector<std::shared_ptr<const Primitive>>& mesh(const Node& index) {
    const std::size_t i = index.index(meshes_.size());
    auto found = read_.find(i);
    if (found == read_.end()) {
      found = read_.emplace(i, read_mesh(meshes_[i], reader_)).first;
    }
    return found->second;
  }

  void draw_mesh(const Node& index, const Node& node, const Matrix& matrix) {
    const auto& primitives = mesh(index);
    if (primitives.empty()) {
      return;
    }
    for (const Matrix& instance : instances_of(node, reader_.accessors)) {
      const Matrix local = multiply(matrix, instance);
      for (const Matrix& outer : to_scene_) {
        const Matrix combined = multiply(outer, local);
        for (const auto& primitive : primitives) {
          reader_.assembler.add_draw(primitive, combined);
        }
      }
    }
  }

  std::vector<Node> nodes_, meshes_;
  const std::vector<Matrix>& to_scene_;
  const Reader& reader_;
  std::vector<bool> seen_;
  std::vector<std::pair<std::size_t, Matrix>> pending_;
  std::map<std::size_t, std::vector<std::shared_ptr<const Primitive>>> read_;
};

} // namespace

void draw_nodes(const Node& root, const std::vector<Matrix>& to_scene, const Reader& reader) {
  const std::vector<Node> scenes = root.elements("scenes");
  if (scenes.empty()) {
    return; // an asset library without a scene shows nothing
  }
  const auto chosen = root.find("scene");
  SceneTraversal traversal(root, to_scene, reader);
  for (const Node& index : scenes[chosen ? chosen->index(scenes.size()) : 0].elements("nodes")) {
    traversal.draw(index);
  }
}

} // namespace firetwin::tiles
