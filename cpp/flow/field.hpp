#pragma once

#include "base/huge_pages.hpp"
#include "flow/lattice.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace firetwin::flow {

/// Field of floats on a lattice, with ghost cells in x and y. Column 0 of each row is at the start
/// of a cache line, and rows have room for full SIMD vectors of columns. A full SIMD vector may be
/// read from any position in a row: the memory is padded at its end.
class Field {
public:
  Field(const Lattice& lattice, Index levels)
      : stride_(lattice.stride), plane_(lattice.plane), levels_(levels),
        values_(static_cast<std::size_t>(levels * lattice.plane + 3 * lanes)),
        empty_(static_cast<std::size_t>(levels * lattice.ny)), ny_(lattice.ny) {}

  Index levels() const { return levels_; }
  /// Points from column 0 of row j of level k.
  float* row(Index k, Index j) { return values_.data() + place(k, j); }
  const float* row(Index k, Index j) const { return values_.data() + place(k, j); }
  void fill_level(Index k, float value) { std::fill_n(row(k, -halo) - halo, plane_, value); }

  /// Nonzero only if all cells of row j of level k are 0; ghost cells do not count. Sweeps set it.
  /// Code that writes other numbers must clear it.
  std::uint8_t& empty(Index k, Index j) { return empty_[static_cast<std::size_t>(k * ny_ + j)]; }
  std::uint8_t empty(Index k, Index j) const {
    return empty_[static_cast<std::size_t>(k * ny_ + j)];
  }
  void clear_empty() { std::fill(empty_.begin(), empty_.end(), std::uint8_t{0}); }

private:
  Index place(Index k, Index j) const { return k * plane_ + (j + halo) * stride_ + lanes; }

  Index stride_;
  Index plane_;
  Index levels_;
  HugeVector<float> values_;
  std::vector<std::uint8_t> empty_;
  Index ny_;
};

} // namespace firetwin::flow
