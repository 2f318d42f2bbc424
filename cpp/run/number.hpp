#pragma once

#include <string>

namespace firetwin::run {

enum class NumberError { none, malformed, too_large };

template <class T> struct Number {
  T value;
  const char* end; ///< one past the last character used
  NumberError error;
};

/// Parses the decimal number at `first` in the syntax of read_text (text.hpp). The caller checks
/// that a separator follows.
template <class T> Number<T> parse_number(const char* first, const char* last);

extern template Number<float> parse_number(const char*, const char*);
extern template Number<double> parse_number(const char*, const char*);

/// Explains why the word at `first` is not a number, and gives a remedy.
std::string explain_word(const char* first, const char* last, NumberError error);

} // namespace firetwin::run
