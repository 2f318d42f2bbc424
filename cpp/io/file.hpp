#pragma once

#include "base/buffer.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

namespace firetwin::io {

/// A regular file opened for positioned reads. Reads, not a memory map: when another program
/// shortens a mapped file, touching it kills the whole process (SIGBUS); a short read is an
/// InputError.
class File {
public:
  /// @throws InputError when the file is missing, unreadable or not a regular file.
  explicit File(std::filesystem::path path);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  File(File&& other) noexcept;
  File& operator=(File&& other) noexcept;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }

  /// Fills `out` from `offset` on. @throws InputError when the file ends before that.
  void read(std::uint64_t offset, std::span<char> out) const;

private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// The whole file; files beyond `limit` bytes are refused before anything is allocated.
Buffer<char> read_all(const std::filesystem::path& path, std::uint64_t limit);

/// The same piece by piece in memory that stays in the processor's cache, each of whole lines (but
/// for the last line of a file, which may lack its end), with the number of bytes after it.
/// @param piece bytes, above 0; longer lines get more
void read_lines(const std::filesystem::path& path, std::uint64_t limit, std::size_t piece,
                const std::function<void(std::span<const char> lines, std::uint64_t left)>& take);

} // namespace firetwin::io
