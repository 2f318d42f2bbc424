#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>

namespace firetwin::io {

/// A file in the making. It is written under another name in the same folder, `NAME.PROCESS.tmp`,
/// and then renamed, so that whoever opens the file finds all of it or none. What was not put in
/// place is removed.
class NewFile {
public:
  /// @throws InputError when the folder is not there.
  explicit NewFile(std::filesystem::path target);
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile();

  /// Where to write.
  const std::filesystem::path& path() const { return temporary_; }
  /// Gives a whole, closed file its name. @throws InputError
  void put_in_place() const;

private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
};

/// Writes a new file through a stream and puts it in place. @return its length in bytes
/// @throws InputError when the folder or the file cannot be written.
std::uint64_t write_file(const std::filesystem::path& path,
                         const std::function<void(std::ostream&)>& write);

} // namespace firetwin::io
