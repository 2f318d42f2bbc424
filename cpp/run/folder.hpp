#pragma once

#include "run/series.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace firetwin::run {

/// Names of all fields that a run may contain.
std::span<const std::string_view> field_names();

/// Files of a run. Symbolic links to targets outside the folder are rejected.
class Folder {
public:
  /// @throws InputError if the folder cannot be read or has a field twice (.txt and .npy)
  explicit Folder(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  /// Names of the known fields in the folder, sorted.
  const std::vector<std::string>& fields() const { return fields_; }
  bool has(std::string_view field) const;
  /// Data files with unknown names, most likely misspelt.
  const std::vector<std::string>& strangers() const { return strangers_; }

  /// Path of a required file in the folder.
  std::filesystem::path file(const std::string& name) const;
  /// Path of the .txt or .npy of a field.
  std::filesystem::path field_file(const std::string& field) const;
  /// Path of the .npy of a field that is read from .npy only.
  std::filesystem::path npy_file(const std::string& field) const;
  Series series(const std::string& field, std::size_t rows, std::size_t columns,
                std::optional<float> no_data) const;

private:
  void add(const std::filesystem::directory_entry& entry);
  std::filesystem::path inside(const std::filesystem::path& path) const;
  std::vector<std::filesystem::path> frames(const std::filesystem::path& folder) const;

  std::filesystem::path path_;
  std::vector<std::string> fields_;
  std::vector<std::string> strangers_;
};

} // namespace firetwin::run
