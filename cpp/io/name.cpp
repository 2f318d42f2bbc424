#include "io/name.hpp"

#include "base/error.hpp"

namespace firetwin::io {

std::string utf8(const std::filesystem::path& path) {
  const std::u8string text = path.u8string();
  return {reinterpret_cast<const char*>(text.data()), text.size()};
}

void fail(const std::filesystem::path& path, const std::string& reason) {
  fail(path, 0, 0, reason);
}

void fail(const std::filesystem::path& path, std::int64_t line, std::int64_t column,
          const std::string& reason) {
  throw InputError(utf8(path), line, column, reason);
}

} // namespace firetwin::io
