#ifndef _WIN32
#include "io/system.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace firetwin::io::system {

int open(const std::filesystem::path& path) {
  return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
}

std::optional<std::uint64_t> size(int descriptor) {
  struct stat status{};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    return std::nullopt;
  }
  return static_cast<std::uint64_t>(status.st_size);
}

std::ptrdiff_t read(int descriptor, std::uint64_t offset, std::span<char> out) {
  const std::size_t most = std::min(out.size(), max_bytes_per_read);
  for (;;) {
    const auto n = ::pread(descriptor, out.data(), most, static_cast<off_t>(offset));
    if (n >= 0 || errno != EINTR) {
      return n;
    }
  }
}

void close(int descriptor) {
  ::close(descriptor);
}

std::filesystem::path canonical(const std::filesystem::path& path, std::error_code& code) {
  return std::filesystem::canonical(path, code);
}

bool sync(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) {
    return false;
  }
  const bool done = ::fsync(descriptor) == 0;
  const int error = errno;
  const bool closed = ::close(descriptor) == 0;
  if (!done) {
    errno = error;
  }
  return done && closed;
}

void rename(const std::filesystem::path& from, const std::filesystem::path& to,
            std::error_code& code) {
  std::filesystem::rename(from, to, code);
}

} // namespace firetwin::io::system
#endif
