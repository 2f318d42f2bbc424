#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace firetwin::fuzz {

/// A regular file in memory, for readers that take a path.
class MemoryFile {
public:
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void write(std::span<const char> bytes) const;

private:
  int descriptor_;
  std::filesystem::path path_;
};

} // namespace firetwin::fuzz
