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

/// What b3dm, i3dm and pnts have in common: a feature table, a batch table (which nobody needs
/// here) and what follows.
struct Sections {
  Bytes feature_json;
  Bytes feature_binary;
  Bytes body;                    ///< glTF, or the uri of one; nothing in pnts
  std::uint32_t gltf_format = 1; ///< of i3dm: 0 when the body is a uri
};

/// Reads the header, of b3dm also in its two older forms.
/// @throws InputError when lengths do not fit the content or the version is not 1
Sections read_sections(Bytes content, ContentType type, const std::string& name);

/// Kinds of numbers in a feature table's binary part.
enum class Number { u8, u16, f32 };

/// A feature table: properties in JSON, longer ones in binary form. It lives as long as the
/// content.
class FeatureTable {
public:
  FeatureTable(const Sections& sections, const std::string& name);

  const Node& json() const { return json_; }
  Bytes binary() const { return binary_; }
  /// A count that must be there, at most `most`.
  std::size_t count(const std::string& key, std::size_t most) const;
  std::optional<Vector> vector(const std::string& key) const;
  /// `n` values of `components` numbers each, or nothing where there is no such property.
  std::optional<std::vector<double>> values(const std::string& key, Number number,
                                            std::size_t components, std::size_t n) const;
  /// POSITION, or POSITION_QUANTIZED in its volume: n x 3, m.
  std::vector<double> positions(std::size_t n) const;
  /// Unit vectors of two numbers each, from 0 to `largest` (octahedral mapping): n x 3.
  std::optional<std::vector<double>> directions(const std::string& key, Number number,
                                                std::size_t n) const;

private:
  Node json_;
  Bytes binary_;
};

} // namespace firetwin::tiles
