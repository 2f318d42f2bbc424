#include "tiles/json.hpp"

#include "base/error.hpp"
#include "tiles/limits.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace firetwin::tiles {
namespace {

using Json = nlohmann::json;

constexpr double largest_whole =
    9007199254740992.0; ///< 2^53, the largest exact integer range of a double

/// Nesting depth of objects and arrays; brackets in strings do not count.
std::size_t depth(std::string_view text) {
  std::size_t open = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      i += c == '\\' ? 1 : 0;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      deepest = std::max(deepest, ++open);
    } else if ((c == '}' || c == ']') && open > 0) {
      --open;
    }
  }
  return deepest;
}

/// The parser's message without its prefix and position.
std::string parser_message(const std::string& what) {
  const std::size_t place = what.find("column ");
  const std::size_t colon = what.find(": ", place == std::string::npos ? 0 : place);
  return colon == std::string::npos ? what : what.substr(colon + 2);
}

[[noreturn]] void refuse_json(std::string_view text, const Json::exception& error,
                              const std::string& content) {
  const auto* parse_error = dynamic_cast<const Json::parse_error*>(&error);
  std::int64_t line = 0, column = 0;
  if (parse_error != nullptr) {
    const std::string_view before =
        text.substr(0, std::min(std::max<std::size_t>(parse_error->byte, 1) - 1, text.size()));
    line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t newline = before.rfind('\n');
    column = static_cast<std::int64_t>(newline == std::string_view::npos ? before.size() + 1
                                                                         : before.size() - newline);
  }
  throw InputError(content, line, column, "its JSON is not valid: " + parser_message(error.what()));
}

} // namespace

void refuse(const std::string& content, const std::string& reason) {
  throw InputError(content, 0, 0, reason);
}

Node parse_json(Bytes bytes, const std::string& content) {
  if (bytes.size() > max_json_bytes) {
    refuse(content, "its JSON has " + std::to_string(bytes.size()) + " bytes; the limit is 64 MB");
  }
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  while (!text.empty() && text.back() == '\0') { // some writers pad with zeros instead of spaces
    text.remove_suffix(1);
  }
  if (depth(text) > max_json_depth) {
    refuse(content, "its JSON is nested deeper than " + std::to_string(max_json_depth));
  }
  try {
    return {std::make_shared<const Json>(Json::parse(text)), content};
  } catch (const Json::exception& error) {
    refuse_json(text, error, content);
  }
}

Node::Node(std::shared_ptr<const Json> document, std::string content)
    : value_(std::move(document)),
      content_(std::make_shared<const std::string>(std::move(content))) {}

Node Node::child(const Json& value, const std::string& name) const {
  Node made(*this);
  made.value_ = {value_, &value};
  made.path_ += '/';
  made.path_ += name;
  return made;
}

void Node::refuse(const std::string& reason) const {
  tiles::refuse(*content_, (path_.empty() ? "/" : path_) + ": " + reason);
}

bool Node::is_object() const {
  return value_->is_object();
}

std::optional<Node> Node::find(std::string_view key) const {
  if (!value_->is_object()) {
    refuse("must be an object");
  }
  const auto found = value_->find(key);
  if (found == value_->end()) {
    return std::nullopt;
  }
  return child(*found, std::string(key));
}

Node Node::at(std::string_view key) const {
  std::optional<Node> found = find(key);
  if (!found) {
    refuse("\"" + std::string(key) + "\" is missing");
  }
  return *std::move(found);
}

std::size_t Node::size() const {
  if (!value_->is_array()) {
    refuse("must be an array");
  }
  return value_->size();
}

Node Node::at(std::size_t element) const {
  if (element >= size()) {
    refuse("has no element " + std::to_string(element));
  }
  return child((*value_)[element], std::to_string(element));
}

std::vector<Node> Node::elements(std::string_view key) const {
  std::vector<Node> all;
  if (const auto array = find(key)) {
    const std::size_t n = array->size();
    all.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
      all.push_back(array->at(i));
    }
  }
  return all;
}

std::vector<std::pair<std::string, Node>> Node::members() const {
  if (!value_->is_object()) {
    refuse("must be an object");
  }
  std::vector<std::pair<std::string, Node>> all;
  for (const auto& [key, value] : value_->items()) {
    all.emplace_back(key, child(value, key));
  }
  return all;
}

void Node::check_length(std::size_t wanted) const {
  if (size() != wanted) {
    refuse("must have " + std::to_string(wanted) + " numbers, not " + std::to_string(size()));
  }
}

bool Node::boolean() const {
  if (!value_->is_boolean()) {
    refuse("must be true or false");
  }
  return value_->get<bool>();
}

double Node::number() const {
  const double value = value_->is_number() ? value_->get<double>() : NAN;
  if (!std::isfinite(value)) {
    refuse("must be a number");
  }
  return value;
}

std::string Node::text() const {
  if (!value_->is_string()) {
    refuse("must be a string");
  }
  return value_->get<std::string>();
}

std::size_t Node::integer() const {
  const double value = number();
  if (value < 0.0 || value > largest_whole || value != std::floor(value)) {
    refuse("must be a whole number, 0 or more");
  }
  return static_cast<std::size_t>(value);
}

std::size_t Node::index(std::size_t size) const {
  const std::size_t value = integer();
  if (value >= size) {
    refuse("is " + std::to_string(value) + ", but there are only " + std::to_string(size));
  }
  return value;
}

bool Node::boolean(std::string_view key, bool absent) const {
  const auto found = find(key);
  return found ? found->boolean() : absent;
}

double Node::number(std::string_view key, double absent) const {
  const auto found = find(key);
  return found ? found->number() : absent;
}

std::size_t Node::integer(std::string_view key, std::size_t absent) const {
  const auto found = find(key);
  return found ? found->integer() : absent;
}

std::string Node::text(std::string_view key, const std::string& absent) const {
  const auto found = find(key);
  return found ? found->text() : absent;
}

std::optional<Node> Node::extension(std::string_view name) const {
  const auto extensions = find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

} // namespace firetwin::tiles
