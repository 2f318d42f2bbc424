#pragma once

#include "base/vector.hpp"

#include <array>

namespace firetwin::tiles {

/// Affine 4 x 4, row after row: a point is a column on its right.
using Matrix = std::array<double, 16>;

constexpr Matrix identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix multiply(const Matrix& a, const Matrix& b);
Matrix translate(const Vector& by);
/// Columns `x`, `y` and `z`, then the translation.
Matrix from_columns(const Vector& x, const Vector& y, const Vector& z, const Vector& by);
/// Translation, then rotation by a quaternion (x, y, z, w) that need not be of length 1, then
/// scale.
Matrix from_parts(const Vector& by, const std::array<double, 4>& rotation, const Vector& scale);
Matrix transpose(const Matrix& m);   ///< of column-major numbers, as glTF writes them
double determinant(const Matrix& m); ///< of its 3 x 3
bool is_affine(const Matrix& m);     ///< finite, the last row 0 0 0 1, determinant not 0
Vector cross(const Vector& a, const Vector& b);
Vector transform_point(const Matrix& m, const Vector& point);
Vector transform_direction(const Matrix& m, const Vector& direction); ///< without the translation
/// What normals are multiplied by: the inverse transpose of the 3 x 3, times the determinant's
/// size.
Matrix for_normals(const Matrix& m);

} // namespace firetwin::tiles
