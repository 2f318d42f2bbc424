#pragma once

#include "base/vector.hpp"

#include <array>

namespace firetwin::tiles {

/// Affine 4 x 4 matrix in row-major order; multiplies column vectors.
using Matrix = std::array<double, 16>;

constexpr Matrix identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix multiply(const Matrix& a, const Matrix& b);
Matrix translate(const Vector& by);
/// Matrix with the columns `x`, `y`, `z` and the translation `by`.
Matrix from_columns(const Vector& x, const Vector& y, const Vector& z, const Vector& by);
/// Translation * rotation * scale; the quaternion (x, y, z, w) need not be normalized.
Matrix from_parts(const Vector& by, const std::array<double, 4>& rotation, const Vector& scale);
Matrix transpose(const Matrix& m);   ///< converts glTF's column-major order
double determinant(const Matrix& m); ///< of the upper left 3 x 3
bool is_affine(const Matrix& m);     ///< finite, last row 0 0 0 1, determinant not 0
Vector cross(const Vector& a, const Vector& b);
Vector transform_point(const Matrix& m, const Vector& point);
Vector transform_direction(const Matrix& m, const Vector& direction); ///< ignores the translation
/// Matrix for normals: the inverse transpose of the upper left 3 x 3, times |determinant|.
Matrix for_normals(const Matrix& m);

} // namespace firetwin::tiles
