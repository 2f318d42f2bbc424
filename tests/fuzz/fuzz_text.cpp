// The text grid reader: no input may do anything but give a full grid or an InputError, and what it
// gave must come back when it is written with enough digits and read again.

#include "check.hpp"
#include "run/text.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

namespace {

using namespace firetwin;

template <class T> std::string written(const Grid<T>& grid) {
  std::string text;
  std::array<char, 64> number{};
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    const auto result = std::to_chars(number.data(), number.data() + number.size(), grid.values[i]);
    text.append(number.data(), result.ptr);
    text += (i + 1) % grid.columns == 0 ? "\n" : " ";
  }
  return text;
}

template <class T> bool same(const Grid<T>& a, const Grid<T>& b) {
  bool equal = a.rows == b.rows && a.columns == b.columns && a.values.size() == b.values.size();
  for (std::size_t i = 0; equal && i < a.values.size(); ++i) {
    const bool both_nan = std::isnan(a.values[i]) && std::isnan(b.values[i]);
    equal = both_nan ||
            (a.values[i] == b.values[i] && std::signbit(a.values[i]) == std::signbit(b.values[i]));
  }
  return equal;
}

template <class T> void read(std::span<const char> text) {
  fuzz::expect_result_or_input_error([&] {
    const Grid<T> grid = run::parse_text<T>(text, "input");
    fuzz::check(grid.rows > 0 && grid.columns > 0, "a grid has rows and columns");
    fuzz::check(grid.values.size() == grid.rows * grid.columns, "a grid is full");
    fuzz::check(same(grid, run::parse_text<T>(written(grid), "again")), "values come back");
  });
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const char> text(reinterpret_cast<const char*>(data), size);
  read<float>(text);
  read<double>(text);
  return 0;
}
