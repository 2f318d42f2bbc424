#pragma once

#include <string>

namespace firetwin::run {

enum class NumberError { none, malformed, too_large };

template <class T> struct Number {
  T value;
  const char* end; ///< one past the last character used
  NumberError error;
};

/// One decimal number at `first`, as read_text (text.hpp) defines it. The caller checks that a
/// separator follows.
template <class T> Number<T> parse_number(const char* first, const char* last);

extern template Number<float> parse_number(const char*, const char*);
extern template Number<double> parse_number(const char*, const char*);

/// Why the word at `first` is no number, and what to do about it.
std::string explain_word(const char* first, const char* last, NumberError error);

} // namespace firetwin::run
