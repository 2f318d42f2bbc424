#include "run/number.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <system_error>

namespace firetwin::run {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Decimal exponent of the leading digit of a well-formed number that is neither 0 nor in range:
/// only its sign matters, so it may saturate.
long long decimal_order(const char* first, const char* last) {
  long long order = 0;
  bool point = false, leading = true;
  const char* c = first;
  for (; c < last && (is_digit(*c) || *c == '.' || *c == '-' || *c == '+'); ++c) {
    if (*c == '.') {
      point = true;
    } else if (is_digit(*c)) {
      leading = leading && *c == '0';
      order += point ? (leading ? -1 : 0) : (leading ? 0 : 1);
    }
  }
  if (c == last) {
    return order;
  }
  ++c; // the E
  const bool negative = c < last && *c == '-';
  long long exponent = 0;
  for (c += (c < last && !is_digit(*c)) ? 1 : 0; c < last && is_digit(*c); ++c) {
    exponent = std::min(exponent * 10 + (*c - '0'), 1'000'000'000'000LL);
  }
  return order + (negative ? -exponent : exponent);
}

template <class T> Number<T> from_chars(const char* first, const char* last) {
  T value{};
  const auto [end, code] = std::from_chars(first, last, value);
  if (code == std::errc::result_out_of_range) {
    if (decimal_order(first, end) > 0) {
      return {value, end, NumberError::too_large};
    }
    return {*first == '-' ? T(-0.0) : T(0.0), end, NumberError::none};
  }
  return {value, end, code == std::errc() ? NumberError::none : NumberError::malformed};
}

/// A number whose exponent is written with D, as Fortran does for double precision.
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

std::string explain_word(const char* first, const char* last, NumberError error) {
  const std::string word = quote_word(first, last);
  if (error == NumberError::too_large) {
    return word + " is too large; the largest value is 3.4028235e38";
  }
  if (*first == '*') {
    return word + " marks a number that did not fit its Fortran format; write it with a wider one";
  }
  if (*first == ',') {
    return "a value is missing before the comma; write nan where there is none";
  }
  return word + " is not a number; write numbers like 12.5, -3e4, 1.0D+03 or nan";
}

} // namespace firetwin::run
