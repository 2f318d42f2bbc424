#include "run/folder.hpp"

#include "io/name.hpp"
#include "io/system.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <map>
#include <system_error>

namespace firetwin::run {
namespace fs = std::filesystem;
namespace {

constexpr std::array<std::string_view, 23> names = {
    "latitude",       "longitude",         "elevation",      "fuel_latitude",   "fuel_longitude",
    "fuel_elevation", "fuel_arrival_time", "fuel_category",  "burned_fraction", "air_latitude",
    "air_longitude",  "surface_fuel",      "canopy_fuel",    "heat_flux",       "temperature",
    "wind_east",      "wind_north",        "temperature_3d", "smoke_3d",        "height_3d",
    "wind_east_3d",   "wind_north_3d",     "wind_up_3d"};

/// The time index in a name like 000042.txt.
std::optional<std::size_t> frame_index(const fs::path& path) {
  const std::string stem = io::utf8(path.stem());
  const bool data = path.extension() == ".txt" || path.extension() == ".npy";
  std::size_t index = 0;
  const auto [end, code] = std::from_chars(stem.data(), stem.data() + stem.size(), index);
  if (!data || stem.size() != 6 || code != std::errc() || end != stem.data() + stem.size()) {
    return std::nullopt;
  }
  return index;
}

std::string frame_name(std::size_t index) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06zu", index);
  return name.data();
}

/// Calls `visit` for each entry. @throws InputError if the folder cannot be read
template <class Visit> void for_each_entry(const fs::path& folder, Visit visit) {
  std::error_code code;
  for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code)) {
    visit(*it);
  }
  if (code) {
    io::fail(folder, "cannot be listed: " + code.message());
  }
}

} // namespace

std::span<const std::string_view> field_names() {
  return names;
}

Folder::Folder(const fs::path& path) {
  std::error_code code;
  path_ = io::system::canonical(path, code);
  if (code) {
    io::fail(path, "there is no such run folder; check the path");
  }
  if (!fs::is_directory(path_, code)) {
    io::fail(path, "is not a folder; give the folder that holds run.toml");
  }
  for_each_entry(path_, [this](const fs::directory_entry& entry) { add(entry); });
  std::sort(fields_.begin(), fields_.end());
  std::sort(strangers_.begin(), strangers_.end());
  const auto twice = std::adjacent_find(fields_.begin(), fields_.end());
  if (twice != fields_.end()) {
    io::fail(path_ / *twice, "exists more than once (.txt, .npy or a folder); keep one of them");
  }
}

void Folder::add(const fs::directory_entry& entry) {
  std::error_code code;
  const fs::path name = entry.path().filename();
  const bool data = name.extension() == ".txt" || name.extension() == ".npy";
  if (!data && !entry.is_directory(code)) {
    return;
  }
  const std::string field = io::utf8(data ? name.stem() : name);
  if (std::find(names.begin(), names.end(), field) != names.end()) {
    fields_.push_back(field);
  } else if (data) {
    strangers_.push_back(io::utf8(name));
  }
}

bool Folder::has(std::string_view field) const {
  return std::binary_search(fields_.begin(), fields_.end(), field);
}

fs::path Folder::inside(const fs::path& path) const {
  std::error_code code;
  const fs::path real = io::system::canonical(path, code);
  if (code) {
    io::fail(path, "the file is missing; a run folder must hold it");
  }
  const auto [end, rest] = std::mismatch(path_.begin(), path_.end(), real.begin(), real.end());
  if (end != path_.end()) {
    io::fail(path, "is a link to a place outside the run folder; put the file itself there");
  }
  return real;
}

fs::path Folder::file(const std::string& name) const {
  return inside(path_ / name);
}

fs::path Folder::field_file(const std::string& field) const {
  std::error_code code;
  const fs::path npy = path_ / (field + ".npy");
  if (fs::exists(npy, code)) {
    return inside(npy);
  }
  const fs::path text = path_ / (field + ".txt");
  if (!fs::exists(text, code)) {
    io::fail(text,
             "the field is missing; a run folder must hold " + field + ".txt or " + field + ".npy");
  }
  return inside(text);
}

fs::path Folder::npy_file(const std::string& field) const {
  std::error_code code;
  const fs::path npy = path_ / (field + ".npy");
  if (!fs::exists(npy, code)) {
    io::fail(npy, "the file is missing; " + field +
                      " is read as one .npy only, save it with numpy.save");
  }
  return inside(npy);
}

std::vector<fs::path> Folder::frames(const fs::path& folder) const {
  std::map<std::size_t, fs::path> found;
  for_each_entry(folder, [&](const fs::directory_entry& entry) {
    if (const auto index = frame_index(entry.path())) {
      if (!found.emplace(*index, entry.path()).second) {
        io::fail(folder / frame_name(*index), "exists as .txt and as .npy; keep one of them");
      }
    }
  });
  std::vector<fs::path> result;
  for (const auto& [index, path] : found) {
    if (index != result.size()) {
      break;
    }
    result.push_back(inside(path));
  }
  if (found.empty() || result.size() < found.size()) {
    io::fail(
        folder / (frame_name(result.size()) + ".txt"),
        "the file is missing; model times are numbered from 000000 on without gaps, as .txt or "
        ".npy");
  }
  return result;
}

Series Folder::series(const std::string& field, std::size_t rows, std::size_t columns,
                      std::optional<float> no_data) const {
  std::error_code code;
  const fs::path npy = path_ / (field + ".npy");
  if (fs::exists(npy, code)) {
    return {NpyFile(inside(npy)), rows, columns, no_data};
  }
  const fs::path folder = path_ / field;
  if (!fs::is_directory(folder, code)) {
    io::fail(folder, "the field is missing; a run folder must hold " + field + ".npy or " + field +
                         "/000000.txt and so on");
  }
  return {frames(inside(folder)), rows, columns, no_data};
}

} // namespace firetwin::run
