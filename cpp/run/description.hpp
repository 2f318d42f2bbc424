#pragma once

#include <optional>
#include <string>
#include <vector>

namespace firetwin::run {

/// Contents of run.toml.
struct Description {
  std::string name;
  std::string start;                ///< UTC, "2014-09-17T04:45:00Z"
  int offset = 0;                   ///< offset of `start` in run.toml, minutes east of UTC
  std::string vertical;             ///< "orthometric" or "ellipsoidal"
  std::optional<double> interval_s; ///< exactly one of interval_s and times_s is given
  std::vector<double> times_s;      ///< strictly ascending seconds since start
  double zero_s = 0.0;              ///< time at `start` in the run's files
  std::optional<double> mean_s;     ///< each heat flux is the mean over the seconds before its time
  std::optional<double> no_data;    ///< value that marks missing data
  bool synthetic = false;
  std::string event;
  std::string zone; ///< such as "Europe/Paris"; empty if not given
  std::vector<std::string> warnings;
};

} // namespace firetwin::run
