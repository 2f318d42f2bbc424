#include "io/file.hpp"

#include "io/name.hpp"
#include "io/system.hpp"

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

namespace firetwin::io {

File::File(std::filesystem::path path) : path_(std::move(path)) {
  descriptor_ = system::open(path_);
  if (descriptor_ < 0) {
    fail(path_, errno == ENOENT ? "the file is missing; check the folder and the name"
                                : std::string("cannot be opened: ") + std::strerror(errno));
  }
  const auto size = system::size(descriptor_);
  if (!size) {
    system::close(descriptor_);
    fail(path_, "is not a regular file; put the data itself there");
  }
  size_ = *size;
}

File::~File() {
  if (descriptor_ >= 0) {
    system::close(descriptor_);
  }
}

File::File(File&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_) {}

File& File::operator=(File&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  return *this;
}

void File::read(std::uint64_t offset, std::span<char> out) const {
  std::size_t done = 0;
  while (done < out.size()) {
    const auto n = system::read(descriptor_, offset + done, out.subspan(done));
    if (n < 0) {
      fail(path_, std::string("cannot be read: ") + std::strerror(errno));
    }
    if (n == 0) {
      fail(path_, "ends after " + std::to_string(offset + done) + " bytes, " +
                      std::to_string(out.size() - done) + " too early; copy the file again");
    }
    done += static_cast<std::size_t>(n);
  }
}

Buffer<char> read_all(const std::filesystem::path& path, std::uint64_t limit) {
  const File file(path);
  if (file.size() > limit) {
    fail(path, "is " + std::to_string(file.size()) + " bytes long, more than the limit of " +
                   std::to_string(limit) + "; convert it to .npy");
  }
  Buffer<char> bytes(file.size());
  file.read(0, bytes);
  return bytes;
}

} // namespace firetwin::io
