#pragma once

#include <fast_float/fast_float.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <system_error>
#include <type_traits>

namespace firetwin::run {
namespace decimal {

inline constexpr std::array<double, 23> powers_of_ten{
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

constexpr std::ptrdiff_t max_digits = 15; ///< decimal digits that a double represents exactly
constexpr std::ptrdiff_t room = 24;       ///< upper bound of the characters that read_short reads

inline unsigned digit(char c) {
  return static_cast<unsigned char>(c) - unsigned{'0'};
}

/// Appends the digits from `place` to `limit` to `number`. Returns the first other character.
inline const char* read_digits(const char* place, const char* limit, std::uint64_t& number) {
  for (; place < limit && digit(*place) < 10; ++place) {
    number = 10 * number + digit(*place);
  }
  return place;
}

/// Reads a short number such as `-1.234567e+03`, the form of nearly all values in model output. Its
/// digits and its power of ten are exact doubles, so that their product or quotient is correctly
/// rounded (Clinger 1990, "How to read floating point numbers accurately"). A float is rounded from
/// that double, which is correct unless the double is half-way between two floats. Plain loops and
/// branches: processors predict them and overlap consecutive numbers.
///
/// @return one past the last character used, or nullptr for other text
template <class T> const char* read_short(const char* first, const char* last, T& value) {
  if (last - first < room) {
    return nullptr;
  }
  const bool negative = *first == '-';
  const char* begin = first + (negative ? 1 : 0);
  std::uint64_t number = 0;
  const char* place = read_digits(begin, begin + max_digits + 1, number);
  std::ptrdiff_t digits = place - begin;
  int exponent = 0;
  if (*place == '.') {
    const char* fraction = ++place;
    place = read_digits(fraction, begin + max_digits + 2, number);
    digits += place - fraction;
    exponent = -static_cast<int>(place - fraction);
  }
  if (digits == 0 || digits > max_digits) {
    return nullptr;
  }
  if (*place == 'e' || *place == 'E') {
    const bool down = place[1] == '-';
    place += down || place[1] == '+' ? 2 : 1;
    const unsigned tens = digit(place[0]);
    const unsigned ones = digit(place[1]);
    if (tens > 9 || ones > 9 || digit(place[2]) < 10) {
      return nullptr;
    }
    place += 2;
    const int shift = static_cast<int>(10 * tens + ones);
    exponent += down ? -shift : shift;
  }
  const auto power = static_cast<std::size_t>(exponent < 0 ? -exponent : exponent);
  if (power >= powers_of_ten.size()) {
    return nullptr;
  }
  double result = static_cast<double>(number);
  result = exponent < 0 ? result / powers_of_ten[power] : result * powers_of_ten[power];
  if constexpr (std::is_same_v<T, float>) {
    if ((std::bit_cast<std::uint64_t>(result) & 0x1FFFFFFF) == 0x10000000) {
      return nullptr;
    }
  }
  value = static_cast<T>(negative ? -result : result);
  return place;
}

} // namespace decimal

/// Parses a decimal number to the nearest T, as fast_float::from_chars, with a fast path for short
/// numbers.
template <class T>
fast_float::from_chars_result read_decimal(const char* first, const char* last, T& value) {
  if (const char* end = decimal::read_short(first, last, value)) {
    return {end, std::errc()};
  }
  return fast_float::from_chars(first, last, value);
}

} // namespace firetwin::run
