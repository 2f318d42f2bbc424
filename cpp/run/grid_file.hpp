#pragma once

#include "base/grid.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace firetwin::run {

/// Reads a text or .npy grid (told apart by content). A one-dimensional array is one row.
/// @throws InputError for everything that text.hpp and npy.hpp refuse, and for three dimensions.
Grid<float> read_grid(const std::filesystem::path& path);
Grid<double> read_double_grid(const std::filesystem::path& path);

/// Reads a grid that must be rows x columns, with no_data as NaN.
/// @throws InputError also for an array of one dimension, even of as many values.
void read_grid(const std::filesystem::path& path, std::size_t rows, std::size_t columns,
               std::optional<float> no_data, std::span<float> out);
/// The same with every digit and no_data as it is.
Grid<double> read_double_grid(const std::filesystem::path& path, std::size_t rows,
                              std::size_t columns);

/// Replaces the value that stands for "no value" by NaN.
void blank(std::span<float> values, std::optional<float> no_data);

/// "144 rows of 144 values"
std::string size_text(std::size_t rows, std::size_t columns);

} // namespace firetwin::run
