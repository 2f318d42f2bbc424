#include "io/new_file.hpp"

#include "io/name.hpp"
#include "io/system.hpp"

#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

namespace firetwin::io {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void cannot_write(const fs::path& path, const std::error_code& code) {
  fail(path, "cannot be written: " + code.message());
}

} // namespace

NewFile::NewFile(fs::path target) : target_(std::move(target)), temporary_(target_) {
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  std::error_code code;
  if (!fs::is_directory(folder, code)) {
    fail(folder, "no such folder; make it first");
  }
  temporary_ += "." + std::to_string(system::process()) + ".tmp";
}

NewFile::~NewFile() {
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void NewFile::put_in_place() const {
  std::error_code code;
  fs::rename(temporary_, target_, code);
  if (code) {
    cannot_write(target_, code);
  }
}

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
    cannot_write(path, {errno, std::generic_category()});
  }
  file.put_in_place();
  return bytes;
}

} // namespace firetwin::io
