#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <system_error>

/// File operations that depend on the operating system: system_posix.cpp, system_windows.cpp.
namespace firetwin::io::system {

/// Opens a file for reading. Returns a descriptor, or -1 with errno set. Does not block on a named
/// pipe.
int open(const std::filesystem::path& path);

/// Size of a regular file in bytes; empty for other files.
std::optional<std::uint64_t> size(int descriptor);

/// Bytes per read call: the limit of macOS is 2^31 - 1, of Windows 2^32 - 1.
constexpr std::size_t max_bytes_per_read = 1U << 30;

/// Reads up to out.size() bytes from `offset` without moving the file position. Returns the number
/// of bytes read, 0 at the end of the file, or -1 with errno set.
std::ptrdiff_t read(int descriptor, std::uint64_t offset, std::span<char> out);

void close(int descriptor);

/// Absolute path of an existing file or folder, without links. Sets `code` on failure.
std::filesystem::path canonical(const std::filesystem::path& path, std::error_code& code);

/// Flushes a file to the disk. Returns false with errno set on failure.
bool sync(const std::filesystem::path& path);

/// Renames a file, and replaces one of the new name. Sets `code` on failure. Windows refuses this
/// while a program has either file open; it is repeated for 1.5 s, as by files.replace() of Python.
void rename(const std::filesystem::path& from, const std::filesystem::path& to,
            std::error_code& code);

} // namespace firetwin::io::system
