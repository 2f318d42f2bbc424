#include "error.hpp"

#include <utility>

namespace firetwin {
namespace {

std::string message(const std::string& path, std::int64_t line, std::int64_t column,
                    const std::string& reason) {
  std::string text = path;
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
    : Error(message(path, line, column, reason)), path_(std::move(path)), line_(line),
      column_(column), reason_(std::move(reason)) {}

} // namespace firetwin
