#include "tiles/tables.hpp"

#include "tiles/limits.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace firetwin::tiles {
namespace {

/// Older b3dm headers are shorter, so a length field overlaps `{"` or `glTF`. Read as a length,
/// such text is at least this large (0x22 is the quotation mark).
constexpr std::uint32_t min_text_length = 0x22000000;

constexpr std::size_t length_of(Number number) {
  return number == Number::u8 ? 1 : number == Number::u16 ? 2 : 4;
}

struct Lengths {
  std::size_t header = 28;
  std::array<std::size_t, 4> tables{}; ///< feature JSON, feature binary, batch JSON, batch binary
};

std::uint32_t read_uint32(Bytes content, std::size_t index) {
  return load<std::uint32_t>(content.data() + 4 * index);
}

/// Older b3dm: [batches, batch table] in 20 bytes, or [batch JSON, batch binary, batches] in 24.
Lengths read_lengths(Bytes content, ContentType type) {
  Lengths lengths;
  for (std::size_t i = 0; i < 4; ++i) {
    lengths.tables[i] = read_uint32(content, 3 + i);
  }
  if (type == ContentType::i3dm) {
    lengths.header = 32;
  } else if (type == ContentType::b3dm && lengths.tables[2] >= min_text_length) {
    lengths = {20, {0, 0, read_uint32(content, 4), 0}};
  } else if (type == ContentType::b3dm && lengths.tables[3] >= min_text_length) {
    lengths = {24, {0, 0, read_uint32(content, 3), read_uint32(content, 4)}};
  }
  return lengths;
}

/// Trims the content to the length in its header.
Bytes trim_to_length(Bytes content, ContentType type, const std::string& name) {
  const std::size_t header = type == ContentType::i3dm ? 32 : 28;
  if (content.size() < header) {
    refuse(name, std::string("is truncated: a ") + name_of(type) + " header has " +
                     std::to_string(header) + " bytes, but the content has " +
                     std::to_string(content.size()));
  }
  if (read_uint32(content, 1) != 1) {
    refuse(name, std::string("is ") + name_of(type) + " version " +
                     std::to_string(read_uint32(content, 1)) + "; only version 1 is supported");
  }
  const std::size_t length = read_uint32(content, 2);
  if (length > content.size()) {
    refuse(name, "is truncated: its header declares " + std::to_string(length) +
                     " bytes, but the content has " + std::to_string(content.size()));
  }
  if (length < header) {
    refuse(name,
           "its header declares " + std::to_string(length) + " bytes, less than the header itself");
  }
  return content.first(length);
}

Node parse_feature_table(Bytes text, const std::string& name) {
  static constexpr std::array<std::uint8_t, 2> empty = {'{', '}'};
  Node json = parse_json(text.empty() ? Bytes(empty) : text, name);
  if (!json.is_object()) {
    json.refuse("the feature table must be an object");
  }
  return json;
}

double number_at(const std::uint8_t* place, Number number) {
  switch (number) {
  case Number::u8:
    return *place;
  case Number::u16:
    return load<std::uint16_t>(place);
  default:
    return static_cast<double>(load<float>(place));
  }
}

/// Offset of a property in the binary part, after a check that the part contains it.
std::size_t checked_offset(const Node& property, std::size_t length, std::size_t size) {
  const Node place = property.at("byteOffset");
  const std::size_t offset = place.integer();
  if (!within(offset, length, size)) {
    place.refuse("the property needs " + std::to_string(length) + " bytes from byte " +
                 std::to_string(offset) + ", but the table has " + std::to_string(size));
  }
  return offset;
}

} // namespace

Sections read_sections(Bytes content, ContentType type, const std::string& name) {
  content = trim_to_length(content, type, name);
  const Lengths lengths = read_lengths(content, type);
  std::array<Bytes, 4> tables;
  Bytes rest = content.subspan(lengths.header);
  for (std::size_t i = 0; i < 4; ++i) {
    if (lengths.tables[i] > rest.size()) {
      refuse(name, "its tables are longer than the " + std::to_string(content.size()) +
                       " bytes declared in its header");
    }
    tables[i] = rest.first(lengths.tables[i]);
    rest = rest.subspan(lengths.tables[i]);
  }
  return {tables[0], tables[1], rest, type == ContentType::i3dm ? read_uint32(content, 7) : 1};
}

FeatureTable::FeatureTable(const Sections& sections, const std::string& name)
    : json_(parse_feature_table(sections.feature_json, name)), binary_(sections.feature_binary) {}

std::size_t FeatureTable::count(const std::string& key, std::size_t most) const {
  const Node found = json_.at(key);
  const std::size_t n = found.integer();
  if (n > most) {
    found.refuse("is " + std::to_string(n) + "; the limit is " + std::to_string(most));
  }
  return n;
}

std::optional<Vector> FeatureTable::vector(const std::string& key) const {
  const std::optional<std::vector<double>> found = values(key, Number::f32, 3, 1);
  return found ? std::optional<Vector>({(*found)[0], (*found)[1], (*found)[2]}) : std::nullopt;
}

std::optional<std::vector<double>> FeatureTable::values(const std::string& key, Number number,
                                                        std::size_t components,
                                                        std::size_t n) const {
  const std::optional<Node> property = json_.find(key);
  if (!property) {
    return std::nullopt;
  }
  std::vector<double> all;
  if (property->is_object()) {
    const std::size_t length = length_of(number) * components * n;
    const std::uint8_t* place = binary_.data() + checked_offset(*property, length, binary_.size());
    all.resize(components * n);
    for (double& value : all) {
      value = number_at(place, number);
      place += length_of(number);
    }
    return all;
  }
  if (property->size() != components * n) {
    property->refuse("must have " + std::to_string(components * n) + " numbers");
  }
  for (std::size_t i = 0; i < components * n; ++i) {
    all.push_back(property->at(i).number());
  }
  return all;
}

std::vector<double> FeatureTable::positions(std::size_t n) const {
  if (auto positions = values("POSITION", Number::f32, 3, n)) {
    return *std::move(positions);
  }
  auto quantized = values("POSITION_QUANTIZED", Number::u16, 3, n);
  const auto offset = vector("QUANTIZED_VOLUME_OFFSET"), scale = vector("QUANTIZED_VOLUME_SCALE");
  if (!quantized || !offset || !scale) {
    json_.refuse(
        "the feature table has neither POSITION nor POSITION_QUANTIZED with a quantized volume");
  }
  for (std::size_t i = 0; i < quantized->size(); ++i) {
    (*quantized)[i] = (*quantized)[i] / 65535.0 * (*scale)[i % 3] + (*offset)[i % 3];
  }
  return *std::move(quantized);
}

/// Cigolle et al. 2014, A survey of efficient representations for independent unit vectors.
std::optional<std::vector<double>> FeatureTable::directions(const std::string& key, Number number,
                                                            std::size_t n) const {
  const auto encoded = values(key, number, 2, n);
  if (!encoded) {
    return std::nullopt;
  }
  const double largest = number == Number::u8 ? 255.0 : 65535.0;
  std::vector<double> all(3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    double x = (*encoded)[2 * i] / largest * 2.0 - 1.0;
    double y = (*encoded)[2 * i + 1] / largest * 2.0 - 1.0;
    const double z = 1.0 - std::abs(x) - std::abs(y);
    if (z < 0.0) {
      const double folded = (1.0 - std::abs(y)) * (x < 0.0 ? -1.0 : 1.0);
      y = (1.0 - std::abs(x)) * (y < 0.0 ? -1.0 : 1.0);
      x = folded;
    }
    const double length = std::sqrt(x * x + y * y + z * z);
    all[3 * i] = x / length;
    all[3 * i + 1] = y / length;
    all[3 * i + 2] = z / length;
  }
  return all;
}

} // namespace firetwin::tiles
