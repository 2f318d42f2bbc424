#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>

namespace firetwin::io {

/// Writes a new file through a stream. It is written under another name in the same folder,
/// `NAME.RANDOM.tmp`, which no other thread, process or machine uses, and gets its own once it is
/// whole and on the disk, so that whoever opens the file finds all of it or none.
/// @return its length in bytes
/// @throws InputError when the folder is not there or the file cannot be written; nothing is left.
std::uint64_t write_file(const std::filesystem::path& path,
                         const std::function<void(std::ostream&)>& write);

} // namespace firetwin::io
