#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

/// What differs between operating systems: system_posix.cpp, system_windows.cpp.
namespace firetwin::io::system {

/// A descriptor of the file for reading, or -1 with errno set. Does not wait for a named pipe's
/// writer.
int open(const std::filesystem::path& path);

/// Bytes in a regular file; nothing for anything else.
std::optional<std::uint64_t> size(int descriptor);

/// Bytes asked for at once: macOS refuses more than 2^31 - 1, Windows more than 2^32 - 1.
constexpr std::size_t most_at_once = 1U << 30;

/// Reads up to out.size() bytes from `offset` on, or fewer, and leaves the place of other readers
/// alone. The number of bytes read, 0 at the end; -1 with errno set.
std::ptrdiff_t read(int descriptor, std::uint64_t offset, std::span<char> out);

void close(int descriptor);

/// Brings what was written to a file to the disk. False with errno set where that fails.
bool sync(const std::filesystem::path& path);

} // namespace firetwin::io::system
