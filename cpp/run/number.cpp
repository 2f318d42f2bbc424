#include "run/number.hpp"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <system_error>

namespace firetwin::run {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Rounded directly to T (via double it would be rounded twice) with fast_float, which is twice as
/// fast as std::from_chars here.
template <class T> Number<T> from_chars(const char* first, const char* last) {
  T value{};
  const auto [end, code] = fast_float::from_chars(first, last, value);
  if (code == std::errc::invalid_argument) {
    return {T{}, first, NumberError::malformed};
  }
  // Overflow gives an infinity, like the text "inf", which starts with a letter.
  const char start = *first == '-' ? first[1] : *first;
  if (std::isinf(value) && (is_digit(start) || start == '.')) {
    return {value, end, NumberError::too_large};
  }
  return {value, end, NumberError::none};
}

/// Parses a number with a Fortran double-precision exponent (D).
template <class T> Number<T> with_d_exponent(const char* first, const char* d, const char* last) {
  std::array<char, 512> copy{};
  const char* end = d + 1;
  end += end < last && (*end == '-' || *end == '+');
  const char* digits = end;
  while (end < last && is_digit(*end)) {
    ++end;
  }
  if (end == digits || end - first > static_cast<std::ptrdiff_t>(copy.size())) {
    return {T{}, first, NumberError::malformed};
  }
  std::copy(first, end, copy.begin());
  copy[static_cast<std::size_t>(d - first)] = 'e';
  Number<T> number = from_chars<T>(copy.data(), copy.data() + (end - first));
  number.end = first + (number.end - copy.data());
  return number;
}

/// Quotes the word at `first`: at most 24 characters, with unprintable bytes as \xNN.
std::string quote_word(const char* first, const char* last) {
  std::string word;
  for (const char* c = first; c < last && word.size() < 24; ++c) {
    if (*c == ' ' || *c == '\t' || *c == ',' || *c == '\r' || *c == '\n') {
      break;
    }
    if (*c > ' ' && *c <= '~') {
      word += *c;
    } else {
      std::array<char, 8> escape{};
      std::snprintf(escape.data(), escape.size(), "\\x%02x", static_cast<unsigned char>(*c));
      word += escape.data();
    }
  }
  return "'" + word + "'";
}

} // namespace

template <class T> Number<T> parse_number(const char* first, const char* last) {
  if (first + 1 < last && *first == '+' && first[1] != '-') {
    ++first;
  }
  Number<T> number = from_chars<T>(first, last);
  if (number.error != NumberError::malformed && number.end < last &&
      (*number.end == 'D' || *number.end == 'd')) {
    number = with_d_exponent<T>(first, number.end, last);
  }
  return number;
}

template Number<float> parse_number(const char*, const char*);
template Number<double> parse_number(const char*, const char*);

std::string explain_word(const char* first, const char* last, NumberError error) {
  const std::string word = quote_word(first, last);
  if (error == NumberError::too_large) {
    return word + " is too large; the largest value is 3.4028235e38";
  }
  if (*first == '*') {
    return word + " marks a number that did not fit its Fortran format; write it with a wider one";
  }
  if (*first == ',') {
    return "a value is missing before the comma; write nan for missing values";
  }
  return word + " is not a number; write numbers like 12.5, -3e4, 1.0D+03 or nan";
}

} // namespace firetwin::run
