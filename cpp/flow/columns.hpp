#pragma once

#include "flow/filters.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::flow {

/// Horizontal interpolation stencil of a column: bilinear and Catmull-Rom weights.
struct ColumnStencil {
  /// Makes the stencil at a fractional column and row; 0 is the centre of the first.
  ColumnStencil(float column, float row, const Shape& shape);

  std::array<Index, 2> row, column; ///< neighbours of the bilinear stencil
  std::array<float, 2> part;        ///< bilinear weight of the second, along rows and columns
  std::array<Index, 4> wide_row, wide_column;
  std::array<float, 4> row_weight, column_weight; ///< Catmull and Rom (1974)
};

/// Cell values, contiguous by column. Horizontal interpolation processes a complete column, many
/// levels at a time (SIMD).
class Columns {
public:
  Columns() = default;
  /// Copies values [nz][ny][nx] with a stride of `step`.
  Columns(const float* values, const Shape& shape, Index step = 1);

  bool empty() const { return values_.empty(); }
  /// Values of a cell's column, from the lowest level up.
  const float* column(Index row, Index column) const {
    return values_.data() + (row * shape_.nx + column) * shape_.nz;
  }
  /// Interpolates levels `first` to `last` (inclusive) of a column bilinearly. It writes complete
  /// SIMD lanes, so `out` must have room for them.
  void linear(const ColumnStencil& at, Index first, Index last, float* out) const;
  /// Like `linear`, with Catmull-Rom weights.
  void cubic(const ColumnStencil& at, Index first, Index last, float* out) const;

private:
  Shape shape_{};
  std::vector<float> values_;
};

/// Sample points along a column, between level `low` and the next at the fraction `part`. Arrays
/// have complete SIMD lanes; entries beyond `count` are padding.
struct LevelSamples {
  std::vector<std::int32_t> low;
  std::vector<float> part;
  Index count = 0;
};

/// Interpolates linearly between levels.
void linear_between(const LevelSamples& places, const float* levels, float* out);
/// Interpolates between levels by Catmull-Rom splines, which also read the levels below and above.
void cubic_between(const LevelSamples& places, const float* levels, float* out);

} // namespace firetwin::flow
