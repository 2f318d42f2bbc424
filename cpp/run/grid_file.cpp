#include "run/grid_file.hpp"

#include "io/file.hpp"
#include "io/name.hpp"
#include "run/npy.hpp"
#include "run/text.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace firetwin::run {
namespace {

bool is_npy(const std::filesystem::path& path) {
  const io::File file(path);
  std::array<char, 6> magic{};
  if (file.size() < magic.size()) {
    return false;
  }
  file.read(0, magic);
  return std::memcmp(magic.data(), "\x93NUMPY", magic.size()) == 0;
}

/// Treatment of one-dimensional arrays: a row, or an error.
enum class Flat { row, refused };

template <class T> Grid<T> read_npy(const std::filesystem::path& path, Flat flat) {
  const NpyFile file(path);
  const auto& shape = file.shape();
  if (shape.empty() || (shape.size() == 1 && flat == Flat::refused) || shape.size() > 2) {
    io::fail(path, "has shape " + shape_text(shape) +
                       " where two dimensions are needed, latitudes by longitudes; reshape it");
  }
  Grid<T> grid;
  grid.rows = shape.size() == 2 ? shape[0] : 1;
  grid.columns = shape.back();
  if (grid.rows == 0 || grid.columns == 0) {
    io::fail(path, "has shape " + shape_text(shape) + " and so holds no numbers");
  }
  grid.values.resize(grid.rows * grid.columns);
  file.read(0, std::span<T>(grid.values));
  return grid;
}

template <class T> Grid<T> read_any(const std::filesystem::path& path, Flat flat) {
  if (path.extension() == ".npy" || is_npy(path)) {
    return read_npy<T>(path, flat);
  }
  return read_text<T>(path);
}

template <class T>
[[noreturn]] void wrong_size(const std::filesystem::path& path, std::size_t rows,
                             std::size_t columns, const Grid<T>& found) {
  std::string reason = "expected " + size_text(rows, columns) +
                       " (latitudes by longitudes), found " + size_text(found.rows, found.columns);
  if (found.rows == rows && found.columns == 2 * columns) {
    reason += "; decimal commas must be written as points";
  } else if (found.rows == columns && found.columns == rows) {
    reason += "; transpose it so that each row holds one latitude";
  } else {
    reason += "; make the field fit the axes";
  }
  io::fail(path, reason);
}

template <class T>
Grid<T> read_sized(const std::filesystem::path& path, std::size_t rows, std::size_t columns) {
  Grid<T> grid = read_any<T>(path, Flat::refused);
  if (grid.rows != rows || grid.columns != columns) {
    wrong_size(path, rows, columns, grid);
  }
  return grid;
}

} // namespace

Grid<float> read_grid(const std::filesystem::path& path) {
  return read_any<float>(path, Flat::row);
}

Grid<double> read_double_grid(const std::filesystem::path& path) {
  return read_any<double>(path, Flat::row);
}

void read_grid(const std::filesystem::path& path, std::size_t rows, std::size_t columns,
               std::optional<float> no_data, std::span<float> out) {
  const Grid<float> grid = read_sized<float>(path, rows, columns);
  std::copy(grid.values.begin(), grid.values.end(), out.begin());
  blank(out, no_data);
}

Grid<double> read_double_grid(const std::filesystem::path& path, std::size_t rows,
                              std::size_t columns) {
  return read_sized<double>(path, rows, columns);
}

void blank(std::span<float> values, std::optional<float> no_data) {
  if (no_data) {
    std::replace(values.begin(), values.end(), *no_data, std::numeric_limits<float>::quiet_NaN());
  }
}

std::string size_text(std::size_t rows, std::size_t columns) {
  return std::to_string(rows) + (rows == 1 ? " row of " : " rows of ") + std::to_string(columns) +
         (columns == 1 ? " value" : " values");
}

} // namespace firetwin::run
