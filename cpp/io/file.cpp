#include "io/file.hpp"

#include "io/name.hpp"
#include "io/system.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace firetwin::io {

File::File(std::filesystem::path path) : path_(std::move(path)) {
  constexpr auto irregular = "is not a regular file; replace it with a file that holds the data";
  descriptor_ = system::open(path_);
  if (descriptor_ < 0) {
    std::error_code ignored;
    const int error = errno;
    if (std::filesystem::is_directory(path_, ignored)) { // Windows does not open folders
      fail(path_, irregular);
    }
    fail(path_, error == ENOENT ? "the file is missing; check the folder and the name"
                                : std::string("cannot be opened: ") + std::strerror(error));
  }
  const auto size = system::size(descriptor_);
  if (!size) {
    system::close(descriptor_);
    fail(path_, irregular);
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

namespace {

void check_size(const File& file, std::uint64_t limit) {
  if (file.size() > limit) {
    fail(file.path(), "is " + std::to_string(file.size()) + " bytes long, more than the limit of " +
                          std::to_string(limit) + "; convert it to .npy");
  }
}

/// Bytes up to the end of the last complete line; 0 without one.
std::size_t whole_lines(std::span<const char> text) {
  const auto end = std::find(text.rbegin(), text.rend(), '\n');
  return static_cast<std::size_t>(text.rend() - end);
}

} // namespace

Buffer<char> read_all(const std::filesystem::path& path, std::uint64_t limit) {
  const File file(path);
  check_size(file, limit);
  Buffer<char> bytes(file.size());
  file.read(0, bytes);
  return bytes;
}

void read_lines(const std::filesystem::path& path, std::uint64_t limit, std::size_t piece,
                const std::function<void(std::span<const char>, std::uint64_t)>& take) {
  const File file(path);
  check_size(file, limit);
  std::vector<char> buffer(std::min<std::uint64_t>(file.size(), piece));
  std::size_t kept = 0; // bytes of an incomplete line
  for (std::uint64_t offset = 0; offset < file.size();) {
    if (kept == buffer.size()) {
      buffer.resize(2 * buffer.size());
    }
    const auto count = std::min<std::uint64_t>(buffer.size() - kept, file.size() - offset);
    file.read(offset, std::span(buffer).subspan(kept, count));
    offset += count;
    const std::span<const char> text = std::span(buffer).first(kept + count);
    const bool last = offset == file.size();
    const std::size_t used = last ? text.size() : whole_lines(text);
    take(text.first(used), file.size() - offset + (text.size() - used));
    kept = text.size() - used;
    std::memmove(buffer.data(), buffer.data() + used, kept);
  }
}

} // namespace firetwin::io
