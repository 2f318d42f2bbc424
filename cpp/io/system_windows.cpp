#ifdef _WIN32
#include "io/system.hpp"

#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <sys/stat.h>
#include <windows.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <string_view>

namespace firetwin::io::system {

int open(const std::filesystem::path& path) {
  int descriptor = -1;
  ::_wsopen_s(&descriptor, path.c_str(), _O_RDONLY | _O_BINARY | _O_NOINHERIT, _SH_DENYNO, 0);
  return descriptor;
}

std::optional<std::uint64_t> size(int descriptor) {
  struct _stat64 status{};
  if (::_fstat64(descriptor, &status) != 0 || (status.st_mode & _S_IFMT) != _S_IFREG) {
    return std::nullopt;
  }
  return static_cast<std::uint64_t>(status.st_size);
}

std::ptrdiff_t read(int descriptor, std::uint64_t offset, std::span<char> out) {
  OVERLAPPED place{}; // offset of this call, as with pread
  place.Offset = static_cast<DWORD>(offset);
  place.OffsetHigh = static_cast<DWORD>(offset >> 32);
  const auto most = static_cast<DWORD>(std::min(out.size(), max_bytes_per_read));
  const auto handle = reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor));
  DWORD n = 0;
  if (::ReadFile(handle, out.data(), most, &n, &place) == 0) {
    if (::GetLastError() == ERROR_HANDLE_EOF) {
      return 0;
    }
    errno = EIO;
    return -1;
  }
  return static_cast<std::ptrdiff_t>(n);
}

void close(int descriptor) {
  ::_close(descriptor);
}

// GCC's std::filesystem::canonical() fails on network shares, and keeps links.
std::filesystem::path canonical(const std::filesystem::path& path, std::error_code& code) {
  const HANDLE file =
      ::CreateFileW(path.c_str(), 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
                    nullptr, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
  if (file == INVALID_HANDLE_VALUE) {
    code = std::make_error_code(std::errc::no_such_file_or_directory);
    return {};
  }
  std::wstring name(32768, L'\0'); // the longest path of Windows
  const auto size = static_cast<DWORD>(name.size());
  name.resize(::GetFinalPathNameByHandleW(file, name.data(), size, VOLUME_NAME_DOS));
  ::CloseHandle(file);
  constexpr std::wstring_view share = L"\\\\?\\UNC\\", local = L"\\\\?\\";
  if (name.empty()) { // some third-party file systems
    return std::filesystem::absolute(path, code);
  }
  if (name.starts_with(share)) {
    name.replace(0, share.size(), L"\\\\");
  } else if (name.starts_with(local)) {
    name.erase(0, local.size());
  }
  code.clear();
  return name;
}

bool sync(const std::filesystem::path& path) {
  int descriptor = -1; // opened for writing: a handle for reading cannot be flushed
  if (::_wsopen_s(&descriptor, path.c_str(), _O_RDWR | _O_BINARY | _O_NOINHERIT, _SH_DENYNO, 0)) {
    return false;
  }
  const bool done = ::_commit(descriptor) == 0;
  const int error = errno;
  const bool closed = ::_close(descriptor) == 0;
  if (!done) {
    errno = error;
  }
  return done && closed;
}

void rename(const std::filesystem::path& from, const std::filesystem::path& to,
            std::error_code& code) {
  std::filesystem::rename(from, to, code);
  for (const DWORD wait : {50U, 100U, 200U, 400U, 800U}) {
    if (code != std::errc::permission_denied) {
      return;
    }
    ::Sleep(wait); // ms
    std::filesystem::rename(from, to, code);
  }
}

} // namespace firetwin::io::system
#endif
