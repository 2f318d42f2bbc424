#include "base/error.hpp"

#include <array>
#include <cstdio>
#include <utility>

namespace firetwin {
namespace {

constexpr std::size_t max_reason_length = 1000;

/// Escapes control characters: text from a file must not break a message or control a terminal.
std::string one_line(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= ' ' && byte != 0x7F) {
      result += c;
      continue;
    }
    std::array<char, 8> escape{};
    std::snprintf(escape.data(), escape.size(), "\\x%02x", byte);
    result += escape.data();
  }
  return result;
}

/// Truncates at a UTF-8 character boundary.
std::string shortened(std::string text) {
  if (text.size() > max_reason_length) {
    std::size_t end = max_reason_length;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) {
      --end;
    }
    text.resize(end);
    text += " ...";
  }
  return text;
}

std::string message(const std::string& path, std::int64_t line, std::int64_t column,
                    const std::string& reason) {
  std::string text = one_line(path);
  if (line > 0) {
    text += ":" + std::to_string(line);
    if (column > 0) {
      text += ":" + std::to_string(column);
    }
  }
  return text + ": " + reason;
}

} // namespace

InputError::InputError(std::string path, std::int64_t line, std::int64_t column, std::string reason)
    : InputError(std::move(path), line, column, shortened(one_line(reason)), Clean{}) {}

InputError::InputError(std::string path, std::int64_t line, std::int64_t column, std::string reason,
                       Clean)
    : Error(message(path, line, column, reason)), path_(std::move(path)), line_(line),
      column_(column), reason_(std::move(reason)) {}

} // namespace firetwin
