#pragma once

#include <cstdint>
#include <span>

namespace firetwin::terrain {

/// A gridded field [rows columns bands].
template <class T> struct Field {
  const T* values;
  std::int64_t rows, columns, bands;
};

/// Interpolates a field bilinearly at n fractional rows and columns: [n bands]. Beyond its ends it
/// is extrapolated linearly. The result is NaN next to a missing value (NaN).
void interpolate(const Field<float>& field, std::span<const double> row,
                 std::span<const double> column, std::span<double> out);
void interpolate(const Field<double>& field, std::span<const double> row,
                 std::span<const double> column, std::span<double> out);

} // namespace firetwin::terrain
