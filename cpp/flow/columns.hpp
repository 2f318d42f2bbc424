#pragma once

#include "flow/filters.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::flow {

/// Interpolation stencil of a column among the cells' columns: bilinear and Catmull-Rom weights.
struct ColumnStencil {
  /// Stencil at a fractional column and row; 0 is the centre of the first.
  ColumnStencil(float column, float row, const Shape& shape);

  std::array<Index, 2> row, column; ///< neighbours of the bilinear stencil
  std::array<float, 2> part;        ///< bilinear weight of the second, along rows and columns
  std::array<Index, 4> wide_row, wide_column;
  std::array<float, 4> row_weight, column_weight; ///< of Catmull and Rom (1974)
};

/// Values of cells, column by column in memory. Horizontal interpolation is done once for a whole
/// column, many levels at a time (SIMD).
class Columns {
public:
  Columns() = default;
  /// From values [nz][ny][nx] with a stride of `step`.
  Columns(const float* values, const Shape& shape, Index step = 1);

  bool empty() const { return values_.empty(); }
  /// Values of a cell's column, from the lowest level up.
  const float* column(Index row, Index column) const {
    return values_.data() + (row * shape_.nx + column) * shape_.nz;
  }
  /// Levels `first` to `last` (included) of an interpolated column: bilinear. Writes whole lanes,
  /// so `out` must have room for them.
  void linear(const ColumnStencil& at, Index first, Index last, float* out) const;
  /// The same with Catmull-Rom weights.
  void cubic(const ColumnStencil& at, Index first, Index last, float* out) const;

private:
  Shape shape_{};
  std::vector<float> values_;
};

/// Sample points along a column, between level `low` and the next at the fraction `part`. Arrays
/// hold whole lanes; entries beyond `count` are padding.
struct LevelSamples {
  std::vector<std::int32_t> low;
  std::vector<float> part;
  Index count = 0;
};

/// Linear interpolation between levels.
void linear_between(const LevelSamples& places, const float* levels, float* out);
/// Catmull-Rom interpolation between levels. It also reads the levels below and above.
void cubic_between(const LevelSamples& places, const float* levels, float* out);

} // namespace firetwin::flow
