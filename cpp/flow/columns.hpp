#pragma once

#include "flow/filters.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::flow {

/// Where a column stands among the cells' columns: which are round it, and how much each counts.
struct Standing {
  /// At a fractional column and row, 0 in the middle of the first.
  Standing(float column, float row, const Shape& shape);

  std::array<Index, 2> row, column; ///< of the cells that are averaged
  std::array<float, 2> part;        ///< of the way to the second, along rows and columns
  std::array<Index, 4> wide_row, wide_column;
  std::array<float, 4> row_weight, column_weight; ///< of Catmull and Rom (1974)
};

/// Values of cells with those of a column side by side: what lies between columns is found once for
/// all of a column's voxels, many levels at a time.
class Columns {
public:
  Columns() = default;
  /// Of [nz][ny][nx] values that are `step` apart.
  Columns(const float* values, const Shape& shape, Index step = 1);

  bool empty() const { return values_.empty(); }
  /// Of a cell, from the lowest level up.
  const float* column(Index row, Index column) const {
    return values_.data() + (row * shape_.nx + column) * shape_.nz;
  }
  /// Levels `first` to `last`, these included, of a column between others: linear. Makes whole
  /// lanes of them: `out` has room for so many more.
  void linear(const Standing& at, Index first, Index last, float* out) const;
  /// The same, cubic.
  void cubic(const Standing& at, Index first, Index last, float* out) const;

private:
  Shape shape_{};
  std::vector<float> values_;
};

/// Places along a column: `part` of the way from level `low` to the next; in whole lanes, as are
/// the values found at them. Those beyond `count` are any places.
struct Places {
  std::vector<std::int32_t> low;
  std::vector<float> part;
  Index count = 0;
};

/// Values at places between levels: linear.
void linear_between(const Places& places, const float* levels, float* out);
/// The same, cubic: needs the level below `low` and the one beyond the next as well.
void cubic_between(const Places& places, const float* levels, float* out);

} // namespace firetwin::flow
