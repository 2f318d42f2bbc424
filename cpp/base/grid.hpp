#pragma once

#include <cstddef>
#include <vector>

namespace firetwin {

/// Row-major grid of rows x columns.
template <class T> struct Grid {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<T> values;
};

} // namespace firetwin
