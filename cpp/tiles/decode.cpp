#include "tiles/decode.hpp"

#include "tiles/accessors.hpp"
#include "tiles/assembler.hpp"
#include "tiles/buffers.hpp"
#include "tiles/container.hpp"
#include "tiles/content_type.hpp"
#include "tiles/instances.hpp"
#include "tiles/limits.hpp"
#include "tiles/materials.hpp"
#include "tiles/nodes.hpp"
#include "tiles/points.hpp"
#include "tiles/tables.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>
#include <utility>

namespace firetwin::tiles {
namespace {

/// Rotation from glTF's axes to the content's z-up axes.
Matrix to_z_up(UpAxis axis) {
  switch (axis) {
  case UpAxis::x:
    return from_columns({0, 0, 1}, {0, 1, 0}, {-1, 0, 0}, {});
  case UpAxis::y:
    return from_columns({1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {});
  default:
    return identity;
  }
}

/// Calls `each` with every inner content of a cmpt.
void split_composite(Bytes content, const std::string& name,
                     const std::function<void(Bytes, const std::string&)>& each) {
  const auto read_uint32 = [](Bytes bytes, std::size_t i) {
    return static_cast<std::size_t>(load<std::uint32_t>(bytes.data() + 4 * i));
  };
  if (content.size() < 16 || read_uint32(content, 2) > content.size() ||
      read_uint32(content, 2) < 16) {
    refuse(name, "is truncated: its cmpt header does not fit its " +
                     std::to_string(content.size()) + " bytes");
  }
  if (read_uint32(content, 1) != 1) {
    refuse(name, "is cmpt version " + std::to_string(read_uint32(content, 1)) +
                     "; only version 1 is supported");
  }
  const std::size_t count = read_uint32(content, 3);
  Bytes rest = content.first(read_uint32(content, 2)).subspan(16);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string inner = name + "[" + std::to_string(i) + "]";
    const std::size_t length = rest.size() < 12 ? 0 : read_uint32(rest, 2);
    if (length < 12 || length > rest.size()) {
      refuse(inner,
             "its length does not fit the remaining " + std::to_string(rest.size()) + " bytes");
    }
    each(rest.first(length), inner);
    rest = rest.subspan(length);
  }
}

void check_depth(int depth, const std::string& name) {
  if (depth > max_composite_depth) {
    refuse(name, "is nested in more than " + std::to_string(max_composite_depth) + " cmpt files");
  }
}

[[noreturn]] void refuse_content_type(ContentType type, const std::string& name) {
  refuse(name, std::string("is a ") + name_of(type) + ", which has no geometry");
}

/// The glTF of an i3dm and the folder of its files; empty if the resource is missing.
struct Model {
  Bytes content;
  std::string uri;
  std::string folder;
};

Model find_model(const Sections& sections, const std::string& name, const Resources& resources) {
  if (sections.gltf_format > 1) {
    refuse(name, "its gltfFormat is " + std::to_string(sections.gltf_format) + ", not 0 or 1");
  }
  if (sections.gltf_format == 1) {
    return {sections.body, "", ""};
  }
  const std::string uri = read_model_uri(sections);
  const auto found = resources.find(uri);
  return {found == resources.end() ? Bytes() : found->second, uri, folder_of(uri)};
}

class Decoder {
public:
  Decoder(const Resources& resources, const DecodeOptions& options, Assembler& assembler)
      : resources_(resources), options_(options), assembler_(assembler) {}

  void decode(Bytes content, const std::string& name, int depth) {
    const ContentType type = detect_content_type(content, name);
    switch (type) {
    case ContentType::b3dm:
      return decode_b3dm(content, name);
    case ContentType::i3dm:
      return decode_i3dm(content, name);
    case ContentType::pnts:
      return decode_pnts(content, name);
    case ContentType::cmpt:
      check_depth(depth, name);
      return split_composite(content, name, [&](Bytes inner, const std::string& inner_name) {
        decode(inner, inner_name, depth + 1);
      });
    case ContentType::glb:
    case ContentType::gltf:
      return decode_gltf(content, name, "", {options_.to_scene});
    default:
      refuse_content_type(type, name);
    }
  }

private:
  void decode_b3dm(Bytes content, const std::string& name) {
    const Sections sections = read_sections(content, ContentType::b3dm, name);
    const FeatureTable table(sections, name);
    const Matrix centre = translate(table.vector("RTC_CENTER").value_or(Vector{}));
    decode_gltf(sections.body, name, "", {multiply(options_.to_scene, centre)});
  }

  void decode_i3dm(Bytes content, const std::string& name) {
    const Sections sections = read_sections(content, ContentType::i3dm, name);
    const FeatureTable table(sections, name);
    const Model model = find_model(sections, name, resources_);
    if (model.content.empty()) {
      refuse(name, "its model " + model.uri + " is not among the resources");
    }
    std::vector<Matrix> matrices = read_instances(table, options_.to_earth);
    for (Matrix& matrix : matrices) {
      matrix = multiply(options_.to_scene, matrix);
    }
    decode_gltf(model.content, model.uri.empty() ? name : name + " -> " + model.uri, model.folder,
                matrices);
  }

  void decode_pnts(Bytes content, const std::string& name) {
    const Sections sections = read_sections(content, ContentType::pnts, name);
    const FeatureTable table(sections, name);
    const Vector centre = table.vector("RTC_CENTER").value_or(Vector{});
    auto points = read_points(table, assembler_);
    if (points->vertices() > 0) {
      assembler_.add_draw(std::move(points), multiply(options_.to_scene, translate(centre)));
    }
  }

  /// The CESIUM_RTC centre is applied after the y-up to z-up rotation, as in CesiumJS,
  /// cesium-native and 3DTilesRendererJS.
  void decode_gltf(Bytes content, const std::string& name, const std::string& folder,
                   std::vector<Matrix> to_scene) {
    const Container container = open_gltf(content, name);
    const ReserveBytes reserve_bytes = [this](std::size_t bytes) {
      assembler_.reserve_bytes(bytes);
    };
    Buffers buffers(container, resources_, folder, reserve_bytes);
    Accessors accessors(container.root, buffers, reserve_bytes);
    Materials materials(container.root, buffers, resources_, folder, assembler_);
    const auto rtc = container.root.extension("CESIUM_RTC");
    const Vector centre = rtc ? rtc->at("center").numbers<3>() : Vector{};
    const Matrix axes = multiply(translate(centre), to_z_up(options_.up_axis));
    for (Matrix& matrix : to_scene) {
      matrix = multiply(matrix, axes);
    }
    assembler_.add_copyright(container.root.at("asset").text("copyright", ""));
    draw_nodes(container.root, to_scene, {buffers, accessors, materials, assembler_});
  }

  const Resources& resources_;
  const DecodeOptions& options_;
  Assembler& assembler_;
};

void list_missing_resources(Bytes content, const std::string& name, const std::string& folder,
                            const Resources& resources, int depth,
                            std::vector<std::string>& missing) {
  const ContentType type = detect_content_type(content, name);
  if (type == ContentType::cmpt) {
    check_depth(depth, name);
    split_composite(content, name, [&](Bytes inner, const std::string& inner_name) {
      list_missing_resources(inner, inner_name, folder, resources, depth + 1, missing);
    });
    return;
  }
  if (type == ContentType::tileset || type == ContentType::subtree) {
    refuse_content_type(type, name);
  }
  if (type == ContentType::pnts) {
    return;
  }
  Model model{content, "", folder};
  if (type == ContentType::b3dm) {
    model.content = read_sections(content, type, name).body;
  } else if (type == ContentType::i3dm) {
    model = find_model(read_sections(content, type, name), name, resources);
  }
  if (model.content.empty() && !model.uri.empty()) {
    missing.push_back(model.uri);
    return;
  }
  const Container container = open_gltf(model.content, name);
  const auto more = Buffers(container, resources, model.folder, nullptr).missing_uris();
  missing.insert(missing.end(), more.begin(), more.end());
}

} // namespace

Tile decode(Bytes content, const std::string& name, const Resources& resources,
            const DecodeOptions& options) {
  if (!is_affine(options.to_scene) || !is_affine(options.to_earth)) {
    throw std::invalid_argument(
        "matrix must be finite and affine, and its determinant must not be 0");
  }
  Assembler assembler(name);
  Decoder(resources, options, assembler).decode(content, name, 0);
  return assembler.finish();
}

std::vector<std::string> list_missing_resources(Bytes content, const std::string& name,
                                                const Resources& resources) {
  std::vector<std::string> missing;
  list_missing_resources(content, name, "", resources, 0, missing);
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  return missing;
}

} // namespace firetwin::tiles
