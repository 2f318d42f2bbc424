#pragma once

#include <cstdint>
#include <span>

namespace firetwin::terrain {

/// A field [rows columns bands] of points.
template <class T> struct Field {
  const T* values;
  std::int64_t rows, columns, bands;
};

/// Bilinear values [n bands] of a field at n fractional rows and columns; beyond its ends it goes
/// on as between the last two points. Beside a missing value (NaN) the result is NaN.
void interpolate(const Field<float>& field, std::span<const double> row,
                 std::span<const double> column, std::span<double> out);
void interpolate(const Field<double>& field, std::span<const double> row,
                 std::span<const double> column, std::span<double> out);

} // namespace firetwin::terrain
