#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace firetwin::io {

/// Converts a path to UTF-8; on POSIX its bytes are unchanged.
std::string utf8(const std::filesystem::path& path);

/// Throws an InputError for `path`.
[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason);
/// Throws an InputError with a 1-based position in the file.
[[noreturn]] void fail(const std::filesystem::path& path, std::int64_t line, std::int64_t column,
                       const std::string& reason);

} // namespace firetwin::io
