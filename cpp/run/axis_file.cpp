#include "run/axis_file.hpp"

#include "base/grid.hpp"
#include "io/name.hpp"
#include "run/grid_file.hpp"

#include <cmath>
#include <string>

namespace firetwin::run {
namespace {

constexpr double turn = 360.0;
constexpr double latitude_limit = 90.0;
/// Degrees; longitudes of a run may continue eastwards beyond 180 or 360.
constexpr double longitude_limit = 540.0;

void check_value(const std::filesystem::path& path, std::size_t index, double value, double limit) {
  if (std::abs(value) <= limit) {
    return;
  }
  std::string reason = "value " + std::to_string(index + 1) + " is " + std::to_string(value);
  reason += std::isfinite(value) ? ", beyond " + std::to_string(static_cast<int>(limit)) +
                                       " degrees; are latitude and longitude swapped?"
                                 : "; an axis needs a number for every row and column";
  io::fail(path, reason);
}

std::vector<double> read_values(const std::filesystem::path& path, double limit) {
  Grid<double> grid = read_double_grid(path);
  if (grid.rows != 1 && grid.columns != 1) {
    io::fail(path, "expected one row or one column of numbers, found " +
                       size_text(grid.rows, grid.columns));
  }
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    check_value(path, i, grid.values[i], limit);
  }
  return std::move(grid.values);
}

void check_order(const std::filesystem::path& path, const std::vector<double>& v) {
  for (std::size_t i = 1; i < v.size(); ++i) {
    if (v[i] == v[i - 1] || (v[i] > v[i - 1]) != (v[1] > v[0])) {
      io::fail(path, "value " + std::to_string(i + 1) +
                         " is not beyond the one before; an axis must "
                         "ascend or descend throughout, without duplicates");
    }
  }
}

/// Unwraps an axis that has exactly one step of more than 180 degrees.
void unwrap(std::vector<double>& v) {
  std::size_t jumps = 0, at = 0;
  for (std::size_t i = 1; i < v.size(); ++i) {
    if (std::abs(v[i] - v[i - 1]) > turn / 2) {
      ++jumps;
      at = i;
    }
  }
  if (jumps != 1) {
    return;
  }
  const double shift = v[at] < v[at - 1] ? turn : -turn;
  for (; at < v.size(); ++at) {
    v[at] += shift;
  }
}

/// Shifts an axis by multiples of 360 degrees; exact if no shift is needed.
void turn_to(std::vector<double>& v, double around) {
  const double middle = 0.5 * (v.front() + v.back());
  const double turns = std::ceil((middle - around) / turn - 0.5);
  for (double& value : v) {
    value -= turns * turn;
  }
}

} // namespace

std::vector<double> read_latitude(const std::filesystem::path& path) {
  std::vector<double> latitude = read_values(path, latitude_limit);
  check_order(path, latitude);
  return latitude;
}

std::vector<double> read_longitude(const std::filesystem::path& path, double around) {
  std::vector<double> longitude = read_values(path, longitude_limit);
  unwrap(longitude);
  check_order(path, longitude);
  if (std::abs(longitude.back() - longitude.front()) > turn) {
    io::fail(path, "goes more than once around the Earth; keep one turn of it");
  }
  turn_to(longitude, around);
  return longitude;
}

} // namespace firetwin::run
