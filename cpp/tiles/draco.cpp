#include "tiles/draco.hpp"

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include <array>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>

namespace firetwin::tiles {
namespace {

/// Draco allocates memory before it validates the data.
template <class Decode> auto guarded(const Node& place, Decode decode) {
  try {
    auto result = decode();
    if (!result.ok()) {
      place.refuse("its Draco data is damaged: " + result.status().error_msg_string());
    }
    return std::move(result).value();
  } catch (const std::bad_alloc&) {
    place.refuse("its Draco data needs more memory than is available");
  } catch (const std::length_error&) {
    place.refuse("its Draco data needs more memory than is available");
  }
}

draco::DecoderBuffer buffer_of(Bytes compressed) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(compressed.data()), compressed.size());
  return buffer;
}

void check_points(const draco::PointCloud& data, std::size_t points, const Node& place) {
  if (data.num_points() != points) {
    place.refuse("its Draco data has " + std::to_string(data.num_points()) + " points instead of " +
                 std::to_string(points));
  }
}

/// Scale of normalized integers to 0..1 or -1..1; 1 for other values.
float scale_of(const draco::PointAttribute& attribute, bool normalized) {
  if (!normalized || attribute.normalized()) { // Draco scales such values
    return 1.0F;
  }
  switch (attribute.data_type()) {
  case draco::DT_INT8:
    return 1.0F / 127.0F;
  case draco::DT_UINT8:
    return 1.0F / 255.0F;
  case draco::DT_INT16:
    return 1.0F / 32767.0F;
  case draco::DT_UINT16:
    return 1.0F / 65535.0F;
  default:
    return 1.0F;
  }
}

} // namespace

DracoData DracoData::mesh(Bytes compressed, std::size_t points, std::size_t triangles,
                          const Node& place) {
  draco::DecoderBuffer buffer = buffer_of(compressed);
  std::shared_ptr<const draco::Mesh> mesh =
      guarded(place, [&] { return draco::Decoder().DecodeMeshFromBuffer(&buffer); });
  check_points(*mesh, points, place);
  if (mesh->num_faces() != triangles) {
    place.refuse("its Draco data has " + std::to_string(mesh->num_faces()) +
                 " triangles instead of " + std::to_string(triangles));
  }
  return DracoData(std::move(mesh));
}

DracoData DracoData::cloud(Bytes compressed, std::size_t points, const Node& place) {
  draco::DecoderBuffer buffer = buffer_of(compressed);
  std::shared_ptr<const draco::PointCloud> cloud =
      guarded(place, [&] { return draco::Decoder().DecodePointCloudFromBuffer(&buffer); });
  check_points(*cloud, points, place);
  return DracoData(std::move(cloud));
}

std::size_t DracoData::points() const {
  return data_->num_points();
}

std::vector<std::uint32_t> DracoData::triangles() const {
  const auto& mesh = dynamic_cast<const draco::Mesh&>(*data_);
  std::vector<std::uint32_t> all;
  all.reserve(3 * std::size_t{mesh.num_faces()});
  for (std::uint32_t i = 0; i < mesh.num_faces(); ++i) {
    for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i))) {
      all.push_back(corner.value());
    }
  }
  return all;
}

std::vector<float> DracoData::floats(const Node& id, std::size_t components,
                                     bool normalized) const {
  constexpr std::size_t largest_id = std::numeric_limits<std::uint32_t>::max();
  const auto* attribute =
      data_->GetAttributeByUniqueId(static_cast<std::uint32_t>(id.index(largest_id)));
  if (attribute == nullptr) {
    id.refuse("names an attribute that is not in the Draco data");
  }
  if (static_cast<std::size_t>(attribute->num_components()) != components) {
    id.refuse("names an attribute of " + std::to_string(attribute->num_components()) +
              " components instead of " + std::to_string(components));
  }
  const float scale = scale_of(*attribute, normalized);
  std::vector<float> values(components * points());
  std::array<float, 4> value{};
  for (std::uint32_t i = 0; i < data_->num_points(); ++i) {
    const draco::AttributeValueIndex entry = attribute->mapped_index(draco::PointIndex(i));
    if (entry.value() >= attribute->size() ||
        !attribute->ConvertValue<float>(entry, static_cast<std::int8_t>(components),
                                        value.data())) {
      id.refuse("names an attribute whose values cannot be read");
    }
    for (std::size_t c = 0; c < components; ++c) {
      values[i * components + c] = value[c] * scale;
    }
  }
  return values;
}

} // namespace firetwin::tiles
