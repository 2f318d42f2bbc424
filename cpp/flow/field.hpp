#pragma once

#include "flow/lattice.hpp"

#include <algorithm>
#include <vector>

namespace firetwin::flow {

/// Field of floats on a lattice, with ghost cells in x and y. A full SIMD vector may be read from
/// any position in a row: the memory is padded at its end.
class Field {
public:
  Field(const Lattice& lattice, Index levels)
      : stride_(lattice.stride), plane_(lattice.plane), levels_(levels),
        values_(static_cast<std::size_t>(levels * lattice.plane + 2 * lanes)) {}

  Index levels() const { return levels_; }
  /// Points from column 0 of row j of level k.
  float* row(Index k, Index j) { return values_.data() + place(k, j); }
  const float* row(Index k, Index j) const { return values_.data() + place(k, j); }
  void fill_level(Index k, float value) {
    std::fill_n(values_.begin() + k * plane_, plane_, value);
  }

private:
  Index place(Index k, Index j) const { return k * plane_ + (j + halo) * stride_ + halo; }

  Index stride_;
  Index plane_;
  Index levels_;
  std::vector<float> values_;
};

} // namespace firetwin::flow
