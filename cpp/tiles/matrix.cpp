#include "tiles/matrix.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace firetwin::tiles {

Matrix multiply(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      for (std::size_t k = 0; k < 4; ++k) {
        c[4 * row + column] += a[4 * row + k] * b[4 * k + column];
      }
    }
  }
  return c;
}

Matrix translate(const Vector& by) {
  return from_columns({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, by);
}

Matrix from_columns(const Vector& x, const Vector& y, const Vector& z, const Vector& by) {
  return {x[0], y[0], z[0], by[0], x[1], y[1], z[1], by[1], x[2], y[2], z[2], by[2], 0, 0, 0, 1};
}

Matrix from_parts(const Vector& by, const std::array<double, 4>& rotation, const Vector& scale) {
  const auto [x, y, z, w] = rotation;
  const double square = x * x + y * y + z * z + w * w;
  const double s = square > 0.0 ? 2.0 / square : 0.0;
  const Vector i = {1.0 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)};
  const Vector j = {s * (x * y - w * z), 1.0 - s * (x * x + z * z), s * (y * z + w * x)};
  const Vector k = {s * (x * z + w * y), s * (y * z - w * x), 1.0 - s * (x * x + y * y)};
  const auto scaled = [](const Vector& v, double f) {
    return Vector{v[0] * f, v[1] * f, v[2] * f};
  };
  return from_columns(scaled(i, scale[0]), scaled(j, scale[1]), scaled(k, scale[2]), by);
}

Matrix transpose(const Matrix& m) {
  Matrix t{};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      t[4 * row + column] = m[4 * column + row];
    }
  }
  return t;
}

double determinant(const Matrix& m) {
  return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
         m[2] * (m[4] * m[9] - m[5] * m[8]);
}

bool is_affine(const Matrix& m) {
  const double det = determinant(m);
  return std::all_of(m.begin(), m.end(), [](double v) { return std::isfinite(v); }) &&
         m[12] == 0.0 && m[13] == 0.0 && m[14] == 0.0 && m[15] == 1.0 && std::isfinite(det) &&
         det != 0.0;
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector transform_point(const Matrix& m, const Vector& p) {
  return {m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3],
          m[4] * p[0] + m[5] * p[1] + m[6] * p[2] + m[7],
          m[8] * p[0] + m[9] * p[1] + m[10] * p[2] + m[11]};
}

Vector transform_direction(const Matrix& m, const Vector& d) {
  return {m[0] * d[0] + m[1] * d[1] + m[2] * d[2], m[4] * d[0] + m[5] * d[1] + m[6] * d[2],
          m[8] * d[0] + m[9] * d[1] + m[10] * d[2]};
}

Matrix for_normals(const Matrix& m) {
  const Vector x = {m[0], m[4], m[8]}, y = {m[1], m[5], m[9]}, z = {m[2], m[6], m[10]};
  const double sign = determinant(m) < 0.0 ? -1.0 : 1.0;
  const auto signed_cross = [sign](const Vector& a, const Vector& b) {
    const Vector c = cross(a, b);
    return Vector{sign * c[0], sign * c[1], sign * c[2]};
  };
  return from_columns(signed_cross(y, z), signed_cross(z, x), signed_cross(x, y), {});
}

} // namespace firetwin::tiles
