#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>

namespace firetwin::io {

/// Writes a file atomically: writes `NAME.RANDOM.tmp` in the same folder, flushes it to the disk
/// and renames it, so that a reader sees the complete file or none. The random name is unique among
/// threads, processes and machines.
/// @return its length in bytes
/// @throws InputError if the folder does not exist or the file cannot be written; the temporary
/// file is removed
std::uint64_t write_file(const std::filesystem::path& path,
                         const std::function<void(std::ostream&)>& write);

} // namespace firetwin::io
