#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace firetwin::run {

/// What run.toml says.
struct Description {
  std::string name;
  std::string start;                ///< UTC, "2014-09-17T04:45:00Z"
  std::optional<double> interval_s; ///< one of interval_s and times_s is there
  std::vector<double> times_s;      ///< strictly ascending seconds since start
  double zero_s = 0.0;              ///< what the times in the run's files say at `start`
  std::optional<double> mean_s;     ///< each heat flux is the mean over the seconds before its time
  std::string vertical;             ///< "orthometric" or "ellipsoidal"
  std::optional<double> no_data;    ///< the value that stands for "no value"
  bool synthetic = false;
  std::string event;
  std::string zone; ///< "Europe/Paris", "" where it is not said
  int offset = 0;   ///< minutes east of UTC that `start` is written with
  std::vector<std::string> warnings;
};

/// Times far from their start, as those since 1970, are counted from a later one, so that they keep
/// their fractions of a second as 32-bit floats, which pictures are made of: `zero_s` less than in
/// the run's files.
/// `start` may be a date and time of TOML, or a text as parse_iso (iso_time.hpp) reads it.
/// @throws InputError with line and column for bad TOML, unknown or missing keys, wrong types,
/// units
///         other than those of fields.hpp, and times that do not ascend.
Description read_description(const std::filesystem::path& path);

} // namespace firetwin::run
