#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace firetwin::run {

/// A moment as people write it, with its offset from UTC.
struct Moment {
  int year = 0;
  unsigned month = 0, day = 0, hour = 0, minute = 0, second = 0;
  unsigned nanosecond = 0;
  int offset = 0; ///< minutes east of UTC
};

/// Reads an ISO 8601 date and time with its offset from UTC: 2014-09-16T21:45:00-07:00, with a
/// fraction or without seconds, or without the hyphens and colons; a blank may stand for the T. Of
/// a fraction nine digits count. Nothing for anything else, or for a day or time that there is not.
std::optional<Moment> parse_iso(std::string_view text);

/// The same moment in UTC, or so many seconds later, "2014-09-17T04:45:00Z", with nine digits of a
/// fraction where there is one. Nothing before the year 1 or after 9999.
std::optional<std::string> utc_text(const Moment& moment, std::int64_t later = 0);

} // namespace firetwin::run
