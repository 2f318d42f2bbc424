#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace firetwin::run {

struct NpyHeader {
  std::string descr;
  bool fortran_order = false;
  std::vector<std::size_t> shape;
};

/// Parses the dictionary of a .npy header, the Python literal
/// {'descr': '<f4', 'fortran_order': False, 'shape': (3, 4)}: these three keys, once each, in any
/// order.
/// @throws InputError with line 1 and the column in the file
NpyHeader parse_npy_header(std::string_view text, std::size_t offset, const std::string& path);

} // namespace firetwin::run
