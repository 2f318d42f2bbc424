#pragma once

#include "base/error.hpp"

#include <cstdlib>
#include <iostream>
#include <string>

namespace firetwin::fuzz {

/// Ends the program, so that libFuzzer keeps the input, where a promise is broken.
inline void check(bool kept, const std::string& promise) {
  if (!kept) {
    std::cerr << "broken promise: " << promise << '\n';
    std::abort();
  }
}

/// Every error is one short line that names a file, with a place that is 0 or counted from 1.
inline void check_error(const InputError& error) {
  const std::string text = error.what();
  check(!error.path().empty() && text.rfind(error.path(), 0) == 0, "an error names its file");
  check(error.line() >= 0 && error.column() >= 0, "a place is not negative");
  check(!error.reason().empty(), "an error says why");
  check(text.find_first_of("\r\n") == std::string::npos && text.size() < 2000,
        "an error is one line");
}

/// Runs a reader; an InputError is a fine answer, any other exception is not and ends the program.
template <class Read> void expect_result_or_input_error(Read read) {
  try {
    read();
  } catch (const InputError& error) {
    check_error(error);
  }
}

} // namespace firetwin::fuzz
