#include "io/new_file.hpp"

#include "io/name.hpp"
#include "io/system.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <random>
#include <string>
#include <system_error>
#include <utility>

namespace firetwin::io {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void cannot_write(const fs::path& path, const std::error_code& code) {
  fail(path, "cannot be written: " + code.message());
}

[[noreturn]] void cannot_write(const fs::path& path) {
  cannot_write(path, {errno, std::generic_category()});
}

std::string random_name() {
  std::random_device device;
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%08x%08x", device(), device());
  return text.data();
}

/// Temporary file; the destructor removes it unless it was renamed.
class NewFile {
public:
  explicit NewFile(fs::path target) : target_(std::move(target)), temporary_(target_) {
    const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
    std::error_code code;
    if (!fs::is_directory(folder, code)) {
      fail(folder, "no such folder; create it first");
    }
    temporary_ += "." + random_name() + ".tmp";
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile() {
    std::error_code ignored;
    fs::remove(temporary_, ignored);
  }

  const fs::path& path() const { return temporary_; }

  /// Renames the complete, closed file to its final name.
  void put_in_place() const {
    if (!system::sync(temporary_)) {
      cannot_write(target_);
    }
    std::error_code code;
    system::rename(temporary_, target_, code);
    if (code) {
      cannot_write(target_, code);
    }
  }

private:
  fs::path target_;
  fs::path temporary_;
};

} // namespace

std::uint64_t write_file(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  const NewFile file(path);
  std::uint64_t bytes = 0;
  try {
    std::ofstream stream;
    stream.exceptions(std::ios_base::badbit | std::ios_base::failbit);
    stream.open(file.path(), std::ios_base::binary);
    write(stream);
    bytes = static_cast<std::uint64_t>(std::streamoff{stream.tellp()});
    stream.close();
  } catch (const std::ios_base::failure&) {
    cannot_write(path);
  }
  file.put_in_place();
  return bytes;
}

} // namespace firetwin::io
