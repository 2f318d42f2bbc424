#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace firetwin::io {

/// A path, or part of one, as UTF-8 on every system; on POSIX its bytes as they are.
std::string utf8(const std::filesystem::path& path);

/// @throws InputError that names `path`, always.
[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason);
/// The same with a place in the file, counted from 1.
[[noreturn]] void fail(const std::filesystem::path& path, std::int64_t line, std::int64_t column,
                       const std::string& reason);

} // namespace firetwin::io
