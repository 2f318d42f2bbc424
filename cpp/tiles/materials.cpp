#include "tiles/materials.hpp"

#include "tiles/image_header.hpp"
#include "tiles/limits.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

namespace firetwin::tiles {
namespace {

std::string wrapping(const Node& sampler, const char* key) {
  switch (sampler.integer(key, 10497)) {
  case 33071:
    return "clamp";
  case 33648:
    return "mirror";
  default:
    return "repeat";
  }
}

void read_alpha(const Node& node, Material& material) {
  const std::string mode = node.text("alphaMode", "OPAQUE");
  if (mode == "MASK") {
    material.alpha_mode = "mask";
  } else if (mode == "BLEND") {
    material.alpha_mode = "blend";
  }
  material.alpha_cutoff = node.number("alphaCutoff", 0.5);
}

/// Translation * rotation * scale, as specified by the extension.
std::array<double, 6> read_transform(const Node& extension) {
  const auto offset = extension.find("offset"), scale = extension.find("scale");
  const auto by = offset ? offset->numbers<2>() : std::array<double, 2>{0, 0};
  const auto size = scale ? scale->numbers<2>() : std::array<double, 2>{1, 1};
  const double angle = extension.number("rotation", 0.0);
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * size[0], s * size[1], by[0], -s * size[0], c * size[1], by[1]};
}

void check_header(const ImageHeader& header, const Node& node) {
  if (header.kind == "ktx2") {
    node.refuse("is a KTX2 texture (KHR_texture_basisu), which is not supported; convert the "
                "textures to JPEG, "
                "PNG or WebP (gltf-transform does)");
  }
  if (header.kind.empty()) {
    node.refuse("is neither JPEG, PNG nor WebP");
  }
  if (header.width == 0 || header.height == 0) {
    node.refuse("its " + header.kind + " header is damaged");
  }
  if (header.width > max_image_side || header.height > max_image_side) {
    node.refuse("has " + std::to_string(header.width) + " x " + std::to_string(header.height) +
                " pixels; the limit is " + std::to_string(max_image_side) + " per side");
  }
}

Image image_of(Bytes file, const Node& node) {
  const ImageHeader header = read_image_header(file);
  check_header(header, node);
  return {header.kind, header.width, header.height, {file.begin(), file.end()}, ""};
}

/// The image of a texture: the WebP version if there is one, else the source of core glTF.
Node source_of(const Node& texture) {
  if (const auto webp = texture.extension("EXT_texture_webp")) {
    return webp->at("source");
  }
  const auto source = texture.find("source");
  if (!source && texture.extension("KHR_texture_basisu")) {
    texture.refuse(
        "has only a KTX2 image (KHR_texture_basisu), which is not supported; convert the textures "
        "to JPEG, PNG or WebP (gltf-transform does)");
  }
  return source ? *source : texture.at("source");
}

} // namespace

Materials::Materials(const Node& root, Buffers& buffers, const Resources& resources,
                     std::string folder, Assembler& assembler)
    : materials_(root.elements("materials")), textures_(root.elements("textures")),
      samplers_(root.elements("samplers")), images_(root.elements("images")), buffers_(&buffers),
      resources_(&resources), folder_(std::move(folder)), assembler_(&assembler) {}

MaterialUse Materials::use(const Node& index) {
  const std::size_t i = index.index(materials_.size());
  const auto found = used_.find(i);
  if (found != used_.end()) {
    return found->second;
  }
  return used_[i] = read(materials_[i]);
}

MaterialUse Materials::read(const Node& node) {
  Material material;
  MaterialUse use;
  material.double_sided = node.boolean("doubleSided", false);
  read_alpha(node, material);
  const auto older = node.extension("KHR_materials_pbrSpecularGlossiness");
  if (const auto model = older ? older : node.find("pbrMetallicRoughness")) {
    if (const auto colour = model->find(older ? "diffuseFactor" : "baseColorFactor")) {
      material.colour = colour->numbers<4>();
    }
    if (const auto texture = model->find(older ? "diffuseTexture" : "baseColorTexture")) {
      read_texture(*texture, material, use);
    }
  }
  use.material = assembler_->add_material(std::move(material));
  return use;
}

void Materials::read_texture(const Node& reference, Material& material, MaterialUse& use) {
  const Node& texture = textures_[reference.at("index").index(textures_.size())];
  if (!texture.find("source") && !texture.find("extensions")) {
    return; // a texture may have no image
  }
  use.textured = true;
  use.coordinates = reference.integer("texCoord", 0);
  if (const auto moved = reference.extension("KHR_texture_transform")) {
    use.transform = read_transform(*moved);
    use.coordinates = moved->integer("texCoord", use.coordinates);
  }
  if (const auto sampler = texture.find("sampler")) {
    const Node& described = samplers_[sampler->index(samplers_.size())];
    material.wrap_u = wrapping(described, "wrapS");
    material.wrap_v = wrapping(described, "wrapT");
  }
  material.image = image(source_of(texture));
}

int Materials::image(const Node& index) {
  const std::size_t i = index.index(images_.size());
  const auto found = used_images_.find(i);
  if (found != used_images_.end()) {
    return found->second;
  }
  return used_images_[i] = assembler_->add_image(read_image(images_[i]));
}

Image Materials::read_image(const Node& node) {
  const auto uri = node.find("uri");
  if (!uri) {
    const Bytes file = buffers_->view(node.at("bufferView")).bytes;
    assembler_->reserve_bytes(file.size());
    return image_of(file, node);
  }
  const std::string text = uri->text();
  if (is_data_uri(text)) {
    assembler_->reserve_bytes(text.size());
    return image_of(decode_data_uri(*uri), node);
  }
  Image image;
  const auto found = resources_->find(resolve_uri(folder_, text));
  if (found != resources_->end()) {
    image = image_of(found->second, node);
  }
  image.uri = resolve_uri(folder_, text);
  return image;
}

} // namespace firetwin::tiles
