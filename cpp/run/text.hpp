#pragma once

#include "base/grid.hpp"

#include <filesystem>
#include <span>
#include <string>

namespace firetwin::run {

/// Parses a text grid; T is float or double.
///
/// Numbers are separated by blanks, tabs or single commas, and a comma may follow a row's last one;
/// `#` starts a comment; lines end in LF or CRLF; lines without numbers are skipped; a leading
/// UTF-8 byte order mark is skipped. Exponents
/// may be written with E or D. `nan`, `inf` and `infinity` in any case are values. Each value is
/// the T nearest to its decimal text: what is too small becomes 0 (with its sign), what is too
/// large for a T is an error. Every line holds one row; all rows are equally long.
///
/// @param path only names the file in errors
/// @throws InputError with line and column at the first malformed number or ragged row, and for
///         text without any number.
template <class T> Grid<T> parse_text(std::span<const char> text, const std::string& path);

extern template Grid<float> parse_text(std::span<const char>, const std::string&);
extern template Grid<double> parse_text(std::span<const char>, const std::string&);

/// The same from a file of at most 1 GiB.
template <class T> Grid<T> read_text(const std::filesystem::path& path);

extern template Grid<float> read_text(const std::filesystem::path&);
extern template Grid<double> read_text(const std::filesystem::path&);

} // namespace firetwin::run
