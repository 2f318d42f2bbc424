#include "tiles/accessors.hpp"

#include "tiles/limits.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>

namespace firetwin::tiles {
namespace {

constexpr unsigned signed_byte = 5120, unsigned_byte = 5121, signed_short = 5122,
                   unsigned_short = 5123, unsigned_int = 5125, real = 5126;

std::size_t components_of(const Node& type) {
  const std::string name = type.text();
  if (name == "SCALAR") {
    return 1;
  }
  if (name == "VEC2" || name == "VEC3" || name == "VEC4") {
    return static_cast<std::size_t>(name.back() - '0');
  }
  type.refuse("is " + name + "; SCALAR, VEC2, VEC3 and VEC4 are read");
}

template <class From, class To> To converted(From value, bool normalized) {
  if constexpr (std::is_floating_point_v<To> && std::is_integral_v<From>) {
    if (normalized) {
      constexpr auto largest = static_cast<double>(std::numeric_limits<From>::max());
      return static_cast<To>(std::max(static_cast<double>(value) / largest, -1.0));
    }
  }
  return static_cast<To>(value);
}

template <class From, class To>
void convert(const std::uint8_t* from, std::size_t stride, const AccessorType& type, To* to) {
  for (std::size_t i = 0; i < type.count; ++i, from += stride) {
    for (std::size_t c = 0; c < type.components; ++c) {
      *to++ = converted<From, To>(load<From>(from + c * sizeof(From)), type.normalized);
    }
  }
}

/// Converts one component. Indices are checked to be unsigned, so only they become integers.
template <class To>
void convert_elements(const std::uint8_t* from, std::size_t stride, const AccessorType& type,
                      To* to) {
  switch (type.component) {
  case signed_byte:
    return convert<std::int8_t>(from, stride, type, to);
  case unsigned_byte:
    return convert<std::uint8_t>(from, stride, type, to);
  case signed_short:
    return convert<std::int16_t>(from, stride, type, to);
  case unsigned_short:
    return convert<std::uint16_t>(from, stride, type, to);
  case unsigned_int:
    return convert<std::uint32_t>(from, stride, type, to);
  default:
    if constexpr (std::is_floating_point_v<To>) {
      convert<float>(from, stride, type, to);
    }
  }
}

unsigned component_type(const Node& node) {
  const std::size_t type = node.integer();
  const bool known =
      (type >= signed_byte && type <= unsigned_short) || type == unsigned_int || type == real;
  if (!known) {
    node.refuse("is " + std::to_string(type) + ", which is not a glTF component type");
  }
  return static_cast<unsigned>(type);
}

bool is_index(unsigned component) {
  return component == unsigned_byte || component == unsigned_short || component == unsigned_int;
}

} // namespace

std::size_t AccessorType::component_bytes() const {
  return component <= unsigned_byte ? 1 : component <= unsigned_short ? 2 : 4;
}

AccessorType Accessors::type(const Node& index) const {
  const Node& node = nodes_[index.index(nodes_.size())];
  AccessorType type;
  type.count = node.at("count").integer();
  type.components = components_of(node.at("type"));
  type.component = component_type(node.at("componentType"));
  type.normalized = node.boolean("normalized", false);
  const std::size_t limit = type.components == 1 ? max_indices : max_vertices;
  if (type.count > limit) {
    node.at("count").refuse("is " + std::to_string(type.count) + "; the limit is " +
                            std::to_string(limit));
  }
  return type;
}

/// Bytes from the first element on, after a check that the view contains all elements.
Bytes Accessors::elements(const Node& place, Buffers::View view, std::size_t count,
                          std::size_t bytes, std::size_t& stride) {
  stride = view.stride == 0 ? bytes : view.stride;
  if (stride < bytes) {
    place.refuse("its elements of " + std::to_string(bytes) + " bytes overlap: the stride is " +
                 std::to_string(stride));
  }
  const std::size_t offset = place.integer("byteOffset", 0);
  const std::size_t length = count == 0 ? 0 : stride * (count - 1) + bytes;
  if (!within(offset, length, view.bytes.size())) {
    place.refuse("its " + std::to_string(count) + " elements need " + std::to_string(length) +
                 " bytes from byte " + std::to_string(offset) + ", but the view has " +
                 std::to_string(view.bytes.size()));
  }
  return view.bytes.subspan(offset, length);
}

template <class T>
void Accessors::read_sparse(const Node& sparse, const AccessorType& type, std::vector<T>& out) {
  const Node places = sparse.at("indices"), values = sparse.at("values");
  const Node count = sparse.at("count");
  const AccessorType index{count.integer(), 1, component_type(places.at("componentType")), false};
  if (index.count > type.count || !is_index(index.component)) {
    sparse.refuse("replaces " + std::to_string(index.count) + " of " + std::to_string(type.count) +
                  " elements, or its indices are not unsigned");
  }
  std::size_t stride = 0;
  Bytes from =
      elements(places, buffers_->view(places.at("bufferView")), index.count, index.bytes(), stride);
  std::vector<std::uint32_t> which(index.count);
  convert_elements(from.data(), stride, index, which.data());
  from =
      elements(values, buffers_->view(values.at("bufferView")), index.count, type.bytes(), stride);
  AccessorType one = type;
  one.count = 1;
  for (std::size_t i = 0; i < which.size(); ++i) {
    if (which[i] >= type.count) {
      places.refuse("names element " + std::to_string(which[i]) + " of " +
                    std::to_string(type.count));
    }
    convert_elements(from.data() + i * stride, stride, one, &out[which[i] * type.components]);
  }
}

template <class T>
void Accessors::read(const Node& node, const AccessorType& type, std::vector<T>& out) {
  reserve_bytes_(type.count * type.components * sizeof(T));
  out.resize(type.count * type.components); // all zeros without a view
  if (const auto index = node.find("bufferView")) {
    std::size_t stride = 0;
    const Bytes from = elements(node, buffers_->view(*index), type.count, type.bytes(), stride);
    convert_elements(from.data(), stride, type, out.data());
  }
  if (const auto sparse = node.find("sparse")) {
    read_sparse(*sparse, type, out);
  }
}

std::vector<float> Accessors::floats(const Node& index) {
  std::vector<float> values;
  read(nodes_[index.index(nodes_.size())], type(index), values);
  return values;
}

std::vector<std::uint32_t> Accessors::indices(const Node& index) {
  const AccessorType described = type(index);
  if (described.components != 1 || !is_index(described.component)) {
    index.refuse("names an accessor whose numbers cannot be indices");
  }
  std::vector<std::uint32_t> values;
  read(nodes_[index.index(nodes_.size())], described, values);
  return values;
}

} // namespace firetwin::tiles
