// The text grid reader: no input may do anything but give a full grid or an InputError, the same in
// whatever pieces it is read, and its values must be equal when they are written with enough digits
// and read again. The first byte is the size of a piece; the rest is the file.

#include "check.hpp"
#include "memory_file.hpp"
#include "run/text.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <variant>

namespace {

using namespace firetwin;
namespace fs = std::filesystem;

constexpr std::size_t largest = 1U << 16U; ///< bytes; no input is longer

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

/// The grid, or its error.
template <class T> std::variant<Grid<T>, InputError> read(const fs::path& path, std::size_t piece) {
  try {
    return run::read_text<T>(path, piece);
  } catch (const InputError& error) {
    fuzz::check_error(error);
    return error;
  }
}

template <class T> void check(const fs::path& path, std::size_t piece) {
  const auto whole = read<T>(path, largest), parts = read<T>(path, piece);
  fuzz::check(whole.index() == parts.index(), "pieces are read as the whole is");
  if (const auto* error = std::get_if<InputError>(&whole)) {
    fuzz::check(std::strcmp(error->what(), std::get<InputError>(parts).what()) == 0,
                "pieces have the error of the whole");
    return;
  }
  const Grid<T>& grid = std::get<Grid<T>>(whole);
  fuzz::check(grid.rows > 0 && grid.columns > 0, "a grid has rows and columns");
  fuzz::check(grid.values.size() == grid.rows * grid.columns, "a grid is full");
  fuzz::check(same(grid, std::get<Grid<T>>(parts)), "pieces have the values of the whole");
  static const fuzz::MemoryFile again;
  again.write(written(grid));
  fuzz::check(same(grid, run::read_text<T>(again.path())), "values come back");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::MemoryFile memory;
  if (size == 0) {
    return 0;
  }
  memory.write({reinterpret_cast<const char*>(data + 1), size - 1});
  const std::size_t piece = std::size_t{data[0]} + 1;
  check<float>(memory.path(), piece);
  check<double>(memory.path(), piece);
  return 0;
}
