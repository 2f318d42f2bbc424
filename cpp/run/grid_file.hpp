#pragma once

#include "base/grid.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace firetwin::run {

/// Reads a text or .npy grid (detected by content). A one-dimensional array is one row.
/// @throws InputError as read_text and NpyFile, and for three dimensions
Grid<float> read_grid(const std::filesystem::path& path);
Grid<double> read_double_grid(const std::filesystem::path& path);

/// Reads a grid of rows x columns, with no_data as NaN.
/// @throws InputError for another shape, including one-dimensional arrays of the same size
void read_grid(const std::filesystem::path& path, std::size_t rows, std::size_t columns,
               std::optional<float> no_data, std::span<float> out);
/// Reads a grid of rows x columns as doubles; no_data is not replaced.
Grid<double> read_double_grid(const std::filesystem::path& path, std::size_t rows,
                              std::size_t columns);

/// Replaces no_data by NaN.
void blank(std::span<float> values, std::optional<float> no_data);

/// "144 rows of 144 values"
std::string size_text(std::size_t rows, std::size_t columns);

} // namespace firetwin::run
