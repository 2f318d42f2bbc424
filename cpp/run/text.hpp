#pragma once

#include "base/grid.hpp"

#include <cstddef>
#include <filesystem>

namespace firetwin::run {

/// Reads a text grid from a file of at most 1 GiB; T is float or double.
///
/// Numbers are separated by spaces, tabs or single commas; a comma may end a row;
/// `#` starts a comment; lines end in LF or CRLF; lines without numbers are skipped; a leading
/// UTF-8 byte order mark is skipped. Exponents may be written with E or D. `nan`, `inf` and
/// `infinity` in any case are values. Each value is the T nearest to its decimal text: underflow
/// gives a signed 0, overflow is an error. Each line is one row; all rows have the same length.
///
/// @param piece bytes per read; does not affect the result
/// @throws InputError with line and column of the first malformed number or ragged row, and for
/// text without numbers
template <class T>
Grid<T> read_text(const std::filesystem::path& path, std::size_t piece = std::size_t{1} << 18U);

extern template Grid<float> read_text(const std::filesystem::path&, std::size_t);
extern template Grid<double> read_text(const std::filesystem::path&, std::size_t);

} // namespace firetwin::run
