#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace firetwin::run {

/// Contents of run.toml.
struct Description {
  std::string name;
  std::string start;                ///< UTC, "2014-09-17T04:45:00Z"
  std::optional<double> interval_s; ///< exactly one of interval_s and times_s is given
  std::vector<double> times_s;      ///< strictly ascending seconds since start
  double zero_s = 0.0;              ///< time at `start` in the run's files
  std::optional<double> mean_s;     ///< each heat flux is the mean over the seconds before its time
  std::string vertical;             ///< "orthometric" or "ellipsoidal"
  std::optional<double> no_data;    ///< value that marks missing data
  bool synthetic = false;
  std::string event;
  std::string zone; ///< such as "Europe/Paris"; empty if not given
  int offset = 0;   ///< offset of `start` in run.toml, minutes east of UTC
  std::vector<std::string> warnings;
};

/// Reads run.toml. Times far from their start, such as seconds since 1970, are counted from a later
/// start, so that 32-bit floats keep fractions of a second: `zero_s` is subtracted from the times
/// in the run's files. `start` may be a TOML date-time or a string that parse_iso (iso_time.hpp)
/// accepts.
/// @throws InputError with line and column for invalid TOML, unknown or missing keys, wrong types,
/// units not listed in fields.hpp, and times that do not ascend
Description read_description(const std::filesystem::path& path);

} // namespace firetwin::run
