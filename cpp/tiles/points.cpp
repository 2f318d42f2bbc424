#include "tiles/points.hpp"

#include "tiles/draco.hpp"
#include "tiles/limits.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace firetwin::tiles {
namespace {

/// sRGB to linear (IEC 61966-2-1).
double linear(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

/// Clamps to 0..1; 0 for NaN.
double fraction(double value) {
  return value > 0.0 ? std::min(value, 1.0) : 0.0;
}

/// Converts sRGB values from 0..largest to linear 0..1; a fourth component is alpha.
std::vector<float> linear_colours(const std::vector<double>& values, std::size_t components,
                                  double largest) {
  const std::size_t n = values.size() / components;
  std::vector<float> colour(4 * n, 1.0F);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t c = 0; c < components; ++c) {
      const double value = fraction(values[components * i + c] / largest);
      colour[4 * i + c] = static_cast<float>(c < 3 ? linear(value) : value);
    }
  }
  return colour;
}

/// RGB565: 5 bits of red, 6 of green, 5 of blue.
std::vector<float> unpack_565(const std::vector<double>& packed) {
  std::vector<double> values;
  for (const double each : packed) {
    const auto bits = static_cast<std::uint32_t>(fraction(each / 65535.0) * 65535.0 + 0.5);
    values.push_back((bits >> 11U & 31U) / 31.0);
    values.push_back((bits >> 5U & 63U) / 63.0);
    values.push_back((bits & 31U) / 31.0);
  }
  return linear_colours(values, 3, 1.0);
}

std::vector<float> read_colours(const FeatureTable& table, std::size_t n) {
  if (const auto rgba = table.values("RGBA", Number::u8, 4, n)) {
    return linear_colours(*rgba, 4, 255.0);
  }
  if (const auto rgb = table.values("RGB", Number::u8, 3, n)) {
    return linear_colours(*rgb, 3, 255.0);
  }
  if (const auto packed = table.values("RGB565", Number::u16, 1, n)) {
    return unpack_565(*packed);
  }
  if (const auto constant = table.values("CONSTANT_RGBA", Number::u8, 4, 1)) {
    std::vector<float> colour;
    const std::vector<float> one = linear_colours(*constant, 4, 255.0);
    for (std::size_t i = 0; i < n; ++i) {
      colour.insert(colour.end(), one.begin(), one.end());
    }
    return colour;
  }
  return {};
}

std::vector<float> as_float(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

/// Points compressed by Draco (3DTILES_draco_point_compression).
class Compressed {
public:
  Compressed(const Node& extension, const FeatureTable& table, std::size_t n)
      : properties_(extension.at("properties")), data_(decode(extension, table, n)) {}

  std::optional<std::vector<float>> floats(const char* key, std::size_t components,
                                           bool normalized) const {
    const auto id = properties_.find(key);
    return id ? std::optional(data_.floats(*id, components, normalized)) : std::nullopt;
  }

private:
  static DracoData decode(const Node& extension, const FeatureTable& table, std::size_t n) {
    const std::size_t offset = extension.at("byteOffset").integer();
    const std::size_t length = extension.at("byteLength").integer();
    if (!within(offset, length, table.binary().size())) {
      extension.refuse("ends beyond the table's " + std::to_string(table.binary().size()) +
                       " bytes");
    }
    return DracoData::cloud(table.binary().subspan(offset, length), n, extension);
  }

  Node properties_;
  DracoData data_;
};

void read_compressed(const Compressed& compressed, Primitive& made) {
  if (auto position = compressed.floats("POSITION", 3, false)) {
    made.position = *std::move(position);
  }
  if (auto normal = compressed.floats("NORMAL", 3, false)) {
    made.normal = *std::move(normal);
  }
  for (const auto& [key, components] : {std::pair("RGBA", std::size_t{4}), {"RGB", 3}}) {
    const auto colour = compressed.floats(key, components, true);
    if (colour && made.colour.empty()) {
      made.colour = linear_colours({colour->begin(), colour->end()}, components, 1.0);
    }
  }
}

void read_plain(const FeatureTable& table, std::size_t n, Primitive& made) {
  if (made.position.empty()) {
    made.position = as_float(table.positions(n));
  }
  if (made.normal.empty()) {
    const auto plain = table.values("NORMAL", Number::f32, 3, n);
    const auto normal = plain ? plain : table.directions("NORMAL_OCT16P", Number::u8, n);
    made.normal = normal ? as_float(*normal) : std::vector<float>();
  }
  if (made.colour.empty()) {
    made.colour = read_colours(table, n);
  }
}

/// Copies row `from` to row `to` unless the array is empty.
void move_row(std::vector<float>& values, std::size_t from, std::size_t to, std::size_t length) {
  for (std::size_t c = 0; c < length && !values.empty(); ++c) {
    values[to * length + c] = values[from * length + c];
  }
}

std::size_t drop_not_finite(Primitive& made) {
  const std::size_t n = made.vertices();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (std::isfinite(made.position[3 * i]) && std::isfinite(made.position[3 * i + 1]) &&
        std::isfinite(made.position[3 * i + 2])) {
      move_row(made.position, i, kept, 3);
      move_row(made.normal, i, kept, 3);
      move_row(made.colour, i, kept, 4);
      ++kept;
    }
  }
  made.position.resize(3 * kept);
  made.normal.resize(made.normal.empty() ? 0 : 3 * kept);
  made.colour.resize(made.colour.empty() ? 0 : 4 * kept);
  return n - kept;
}

} // namespace

std::shared_ptr<const Primitive> read_points(const FeatureTable& table, Assembler& assembler) {
  const std::size_t n = table.count("POINTS_LENGTH", max_vertices);
  auto made = std::make_shared<Primitive>();
  made->points = true;
  assembler.reserve_bytes(40 * n);
  if (const auto extension = table.json().extension("3DTILES_draco_point_compression")) {
    read_compressed(Compressed(*extension, table, n), *made);
  }
  read_plain(table, n, *made);
  made->has_normals = !made->normal.empty();
  assembler.add_not_finite(drop_not_finite(*made));
  return made;
}

} // namespace firetwin::tiles
