#pragma once

#include "base/buffer.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

namespace firetwin::io {

/// A regular file opened for positioned reads. It is not memory-mapped: if another program
/// truncates a mapped file, access kills the process (SIGBUS); a short read is an InputError
/// instead.
class File {
public:
  /// @throws InputError if the file is missing, unreadable or not a regular file
  explicit File(std::filesystem::path path);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  File(File&& other) noexcept;
  File& operator=(File&& other) noexcept;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }

  /// Fills `out` from `offset` on. @throws InputError if the file ends too early
  void read(std::uint64_t offset, std::span<char> out) const;

private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// Reads a file. @throws InputError, before allocation, if it exceeds `limit` bytes
Buffer<char> read_all(const std::filesystem::path& path, std::uint64_t limit);

/// Reads a file in pieces that fit the processor's cache. Each piece consists of complete lines
/// (the last line of a file may have no line end); `left` is the number of bytes after it.
/// @param piece size of a piece in bytes, above 0; extended for longer lines
void read_lines(const std::filesystem::path& path, std::uint64_t limit, std::size_t piece,
                const std::function<void(std::span<const char> lines, std::uint64_t left)>& take);

} // namespace firetwin::io
