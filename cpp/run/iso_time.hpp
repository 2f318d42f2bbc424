#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace firetwin::run {

/// A date and time with its offset from UTC.
struct Moment {
  int year = 0;
  unsigned month = 0, day = 0, hour = 0, minute = 0, second = 0;
  unsigned nanosecond = 0;
  int offset = 0; ///< minutes east of UTC
};

/// Reads an ISO 8601 date and time with its offset from UTC: 2014-09-16T21:45:00-07:00, with a
/// fraction, without seconds, or in basic format (no hyphens and colons); a space may replace the
/// T. Fractions are truncated to nine digits. Returns an empty optional for other strings and for
/// dates and times that do not exist.
std::optional<Moment> parse_iso(std::string_view text);

/// Formats a time, plus `later` seconds, in UTC: "2014-09-17T04:45:00Z", with nine decimals if
/// there is a fraction. Empty outside the years 1 to 9999.
std::optional<std::string> utc_text(const Moment& moment, std::int64_t later = 0);

} // namespace firetwin::run
