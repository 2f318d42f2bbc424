#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace firetwin {

/// Base of every error that Firetwin raises on purpose.
class Error : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Bad input: names the file, the place (1-based; 0 where none applies) and what to do about it.
/// Control characters of the reason are shown as \xNN, and a reason of more than 1,000 bytes is
/// cut.
class InputError : public Error {
public:
  InputError(std::string path, std::int64_t line, std::int64_t column, std::string reason);

  const std::string& path() const { return path_; }
  std::int64_t line() const { return line_; }
  std::int64_t column() const { return column_; }
  const std::string& reason() const { return reason_; }

private:
  struct Clean {}; ///< the reason is printable and short
  InputError(std::string path, std::int64_t line, std::int64_t column, std::string reason, Clean);

  std::string path_;
  std::int64_t line_;
  std::int64_t column_;
  std::string reason_;
};

} // namespace firetwin
