#include "memory_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

namespace firetwin::fuzz {

MemoryFile::MemoryFile() : descriptor_(::memfd_create("fuzz", 0)) {
  if (descriptor_ < 0) {
    std::abort();
  }
  path_ = "/proc/self/fd/" + std::to_string(descriptor_);
}

MemoryFile::~MemoryFile() {
  ::close(descriptor_);
}

void MemoryFile::write(std::span<const char> bytes) const {
  const auto size = static_cast<ssize_t>(bytes.size());
  if (::ftruncate(descriptor_, size) != 0 ||
      ::pwrite(descriptor_, bytes.data(), bytes.size(), 0) != size) {
    std::abort();
  }
}

} // namespace firetwin::fuzz
