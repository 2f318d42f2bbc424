#pragma once

#include "base/grid.hpp"

#include <cstddef>
#include <filesystem>

namespace firetwin::run {

/// Reads a text grid from a file of at most 1 GiB; T is float or double.
///
/// Numbers are separated by blanks, tabs or single commas, and a comma may follow a row's last one;
/// `#` starts a comment; lines end in LF or CRLF; lines without numbers are skipped; a leading
/// UTF-8 byte order mark is skipped. Exponents
/// may be written with E or D. `nan`, `inf` and `infinity` in any case are values. Each value is
/// the T nearest to its decimal text: what is too small becomes 0 (with its sign), what is too
/// large for a T is an error. Every line holds one row; all rows are equally long.
///
/// @param piece bytes that are read at once (any number above 0 gives the same grid)
/// @throws InputError with line and column at the first malformed number or ragged row, and for
///         text without any number.
template <class T>
Grid<T> read_text(const std::filesystem::path& path, std::size_t piece = std::size_t{1} << 18U);

extern template Grid<float> read_text(const std::filesystem::path&, std::size_t);
extern template Grid<double> read_text(const std::filesystem::path&, std::size_t);

} // namespace firetwin::run
