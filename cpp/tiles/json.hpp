#pragma once

#include "tiles/bytes.hpp"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace firetwin::tiles {

/// Rejects a content. @throws InputError
[[noreturn]] void refuse(const std::string& content, const std::string& reason);

/// A value of a JSON document with its JSON pointer for messages; it keeps the document alive.
/// Accessors throw an InputError with the content and the pointer if the value has another type or
/// range.
class Node {
public:
  Node(std::shared_ptr<const nlohmann::json> document, std::string content);

  bool is_object() const;
  std::optional<Node> find(std::string_view key) const; ///< empty if the key is absent
  Node at(std::string_view key) const;
  std::size_t size() const;           ///< of an array
  Node at(std::size_t element) const; ///< of an array
  /// Elements of the array under `key`; empty if the key is absent.
  std::vector<Node> elements(std::string_view key) const;
  /// Keys and values of an object, sorted by key.
  std::vector<std::pair<std::string, Node>> members() const;

  bool boolean() const;
  double number() const;
  std::string text() const;
  std::size_t integer() const;               ///< an integer, 0 or more
  std::size_t index(std::size_t size) const; ///< an integer from 0 to `size` - 1
  template <std::size_t n> std::array<double, n> numbers() const {
    std::array<double, n> values{};
    check_length(n);
    for (std::size_t i = 0; i < n; ++i) {
      values[i] = at(i).number();
    }
    return values;
  }

  bool boolean(std::string_view key, bool absent) const;
  double number(std::string_view key, double absent) const;
  std::size_t integer(std::string_view key, std::size_t absent) const;
  std::string text(std::string_view key, const std::string& absent) const;
  /// The extension with this name, if there is one.
  std::optional<Node> extension(std::string_view name) const;

  const std::string& content() const { return *content_; }
  /// @throws InputError
  [[noreturn]] void refuse(const std::string& reason) const;

private:
  Node child(const nlohmann::json& value, const std::string& name) const;
  void check_length(std::size_t wanted) const;

  std::shared_ptr<const nlohmann::json> value_; // shares the ownership of the document
  std::shared_ptr<const std::string> content_;
  std::string path_;
};

/// Parses a document of at most 64 MB and 256 nested levels.
/// @throws InputError with line and column in the document
Node parse_json(Bytes text, const std::string& content);

} // namespace firetwin::tiles
