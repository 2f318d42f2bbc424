#include "tiles/instances.hpp"

#include "geo/earth_axes.hpp"
#include "tiles/limits.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

namespace firetwin::tiles {
namespace {

Vector triple(const std::vector<double>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

Matrix inverse_linear(const Matrix& m) {
  const Matrix cofactors = for_normals(m); // inverse transpose times |determinant|
  const double size = std::abs(determinant(m));
  Matrix inverse = identity;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      inverse[4 * row + column] = cofactors[4 * column + row] / size;
    }
  }
  return inverse;
}

/// East-north-up axes of an instance on the ellipsoid, in the content's frame.
Matrix upright(const Vector& position, const Matrix& to_earth, const Matrix& from_earth) {
  const geo::EarthAxes axes = geo::earth_axes(transform_point(to_earth, position));
  const auto unit = [&](const Vector& axis) {
    const Vector v = transform_direction(from_earth, axis);
    const double length = std::sqrt(dot(v, v));
    return Vector{v[0] / length, v[1] / length, v[2] / length};
  };
  return from_columns(unit(axes.east), unit(axes.north), unit(axes.up), {});
}

/// NORMAL_UP or NORMAL_RIGHT, as floats or octahedral-encoded.
std::optional<std::vector<double>> directions(const FeatureTable& table, const std::string& key,
                                              std::size_t n) {
  auto plain = table.values(key, Number::f32, 3, n);
  return plain ? plain : table.directions(key + "_OCT32P", Number::u16, n);
}

Matrix scaled(const Matrix& rotation, const Vector& scale, const Vector& by) {
  return from_columns({rotation[0] * scale[0], rotation[4] * scale[0], rotation[8] * scale[0]},
                      {rotation[1] * scale[1], rotation[5] * scale[1], rotation[9] * scale[1]},
                      {rotation[2] * scale[2], rotation[6] * scale[2], rotation[10] * scale[2]},
                      by);
}

} // namespace

std::vector<Matrix> read_instances(const FeatureTable& table, const Matrix& to_earth) {
  const std::size_t n = table.count("INSTANCES_LENGTH", max_instances);
  const std::vector<double> position = table.positions(n);
  const Vector centre = table.vector("RTC_CENTER").value_or(Vector{});
  const auto up = directions(table, "NORMAL_UP", n), right = directions(table, "NORMAL_RIGHT", n);
  const auto scale = table.values("SCALE", Number::f32, 1, n);
  const auto scales = table.values("SCALE_NON_UNIFORM", Number::f32, 3, n);
  const bool east_north_up = table.json().boolean("EAST_NORTH_UP", false);
  const Matrix from_earth = inverse_linear(to_earth);
  std::vector<Matrix> matrices;
  matrices.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    Vector place = triple(position, i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      place[axis] += centre[axis];
    }
    Matrix rotation = identity;
    if (up && right) {
      const Vector x = triple(*right, i), y = triple(*up, i);
      rotation = from_columns(x, y, cross(x, y), {});
    } else if (east_north_up) {
      rotation = upright(place, to_earth, from_earth);
    }
    Vector size = scales ? triple(*scales, i) : Vector{1, 1, 1};
    for (double& each : size) {
      each *= scale ? (*scale)[i] : 1.0;
    }
    matrices.push_back(scaled(rotation, size, place));
  }
  return matrices;
}

std::string read_model_uri(const Sections& sections) {
  std::string_view text(reinterpret_cast<const char*>(sections.body.data()), sections.body.size());
  while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) {
    text.remove_suffix(1);
  }
  return std::string(text);
}

} // namespace firetwin::tiles
