#pragma once

#include "tiles/bytes.hpp"
#include "tiles/content_type.hpp"
#include "tiles/json.hpp"
#include "tiles/matrix.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace firetwin::tiles {

/// Parts of a b3dm, i3dm or pnts: the feature table and the body. The batch table is skipped.
struct Sections {
  Bytes feature_json;
  Bytes feature_binary;
  Bytes body;                    ///< glTF or its uri; empty in pnts
  std::uint32_t gltf_format = 1; ///< i3dm: 0 if the body is a uri
};

/// Reads the header; supports the two older b3dm headers.
/// @throws InputError if lengths do not fit the content or the version is not 1
Sections read_sections(Bytes content, ContentType type, const std::string& name);

/// Component types in a feature table's binary part.
enum class Number { u8, u16, f32 };

/// A feature table: properties in JSON or in binary form. The content must outlive it.
class FeatureTable {
public:
  FeatureTable(const Sections& sections, const std::string& name);

  const Node& json() const { return json_; }
  Bytes binary() const { return binary_; }
  /// Reads a required count. @throws InputError if it is missing or above `most`
  std::size_t count(const std::string& key, std::size_t most) const;
  std::optional<Vector> vector(const std::string& key) const;
  /// Reads `n` values with `components` numbers each; empty if the property is absent.
  std::optional<std::vector<double>> values(const std::string& key, Number number,
                                            std::size_t components, std::size_t n) const;
  /// Reads POSITION or dequantizes POSITION_QUANTIZED: n x 3, m.
  std::vector<double> positions(std::size_t n) const;
  /// Decodes octahedral-encoded unit vectors: n x 3.
  std::optional<std::vector<double>> directions(const std::string& key, Number number,
                                                std::size_t n) const;

private:
  Node json_;
  Bytes binary_;
};

} // namespace firetwin::tiles
