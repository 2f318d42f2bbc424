#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace firetwin {

/// Base class of Firetwin's errors.
class Error : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Invalid input: file, position (1-based; 0 if not applicable) and reason with a remedy. Control
/// characters in the reason are escaped as \xNN; reasons above 1,000 bytes are truncated.
class InputError : public Error {
public:
  InputError(std::string path, std::int64_t line, std::int64_t column, std::string reason);

  const std::string& path() const { return path_; }
  std::int64_t line() const { return line_; }
  std::int64_t column() const { return column_; }
  const std::string& reason() const { return reason_; }

private:
  struct Clean {}; ///< tag: the reason is escaped and truncated
  InputError(std::string path, std::int64_t line, std::int64_t column, std::string reason, Clean);

  std::string path_;
  std::int64_t line_;
  std::int64_t column_;
  std::string reason_;
};

} // namespace firetwin
