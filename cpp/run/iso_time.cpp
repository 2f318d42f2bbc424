#include "run/iso_time.hpp"

#include <array>
#include <chrono>
#include <cstdio>

namespace firetwin::run {
namespace {

/// Parses a string from left to right; after the first failure all further steps fail.
class Scanner {
public:
  explicit Scanner(std::string_view text) : rest_(text) {}

  bool good() const { return good_; }
  bool at_end() const { return rest_.empty(); }

  bool accept(std::string_view any_of) {
    if (rest_.empty() || any_of.find(rest_.front()) == std::string_view::npos) {
      return false;
    }
    rest_.remove_prefix(1);
    return true;
  }

  void expect(std::string_view any_of) { good_ = accept(any_of) && good_; }

  /// Reads a number with exactly this many digits.
  unsigned number(int digits) {
    unsigned value = 0;
    for (int i = 0; i < digits; ++i) {
      value = 10 * value + digit();
    }
    return value;
  }

  bool at_digit() const { return !rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9'; }

  unsigned digit() {
    if (!at_digit()) {
      good_ = false;
      return 0;
    }
    const auto value = static_cast<unsigned>(rest_.front() - '0');
    rest_.remove_prefix(1);
    return value;
  }

private:
  std::string_view rest_;
  bool good_ = true;
};

void read_date(Scanner& scanner, Moment& moment) {
  moment.year = static_cast<int>(scanner.number(4));
  const bool hyphens = scanner.accept("-");
  moment.month = scanner.number(2);
  if (hyphens) {
    scanner.expect("-");
  }
  moment.day = scanner.number(2);
}

unsigned read_fraction(Scanner& scanner) {
  unsigned nanosecond = scanner.digit();
  int digits = 1;
  for (; scanner.at_digit(); ++digits) {
    const unsigned next = scanner.digit();
    nanosecond = digits < 9 ? 10 * nanosecond + next : nanosecond;
  }
  for (; digits < 9; ++digits) {
    nanosecond *= 10;
  }
  return nanosecond;
}

void read_time(Scanner& scanner, Moment& moment) {
  moment.hour = scanner.number(2);
  const bool colons = scanner.accept(":");
  moment.minute = scanner.number(2);
  if (colons ? scanner.accept(":") : scanner.at_digit()) {
    moment.second = scanner.number(2);
    if (scanner.accept(".,")) {
      moment.nanosecond = read_fraction(scanner);
    }
  }
}

void read_offset(Scanner& scanner, Moment& moment) {
  if (scanner.accept("Zz")) {
    return;
  }
  const bool west = scanner.accept("-");
  if (!west) {
    scanner.expect("+");
  }
  const unsigned hours = scanner.number(2);
  unsigned minutes = 0;
  if (scanner.accept(":") || scanner.at_digit()) {
    minutes = scanner.number(2);
  }
  if (hours > 23 || minutes > 59) {
    scanner.expect(""); // no offset: fails
  }
  moment.offset = static_cast<int>(60 * hours + minutes) * (west ? -1 : 1);
}

std::chrono::year_month_day date_of(const Moment& m) {
  return std::chrono::year(m.year) / std::chrono::month(m.month) / std::chrono::day(m.day);
}

} // namespace

std::optional<Moment> parse_iso(std::string_view text) {
  Scanner scanner(text);
  Moment moment;
  read_date(scanner, moment);
  scanner.expect("Tt ");
  read_time(scanner, moment);
  read_offset(scanner, moment);
  const bool there =
      date_of(moment).ok() && moment.hour < 24 && moment.minute < 60 && moment.second < 60;
  if (!scanner.good() || !scanner.at_end() || !there) {
    return std::nullopt;
  }
  return moment;
}

std::optional<std::string> utc_text(const Moment& moment, std::int64_t later) {
  using namespace std::chrono;
  const auto utc = sys_days(date_of(moment)) + hours(moment.hour) +
                   minutes(static_cast<int>(moment.minute) - moment.offset) +
                   seconds(moment.second) + seconds(later);
  const sys_days day = floor<days>(utc);
  const year_month_day date(day);
  const hh_mm_ss clock(utc - day);
  if (static_cast<int>(date.year()) < 1 || static_cast<int>(date.year()) > 9999) {
    return std::nullopt;
  }
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02uT%02d:%02d:%02d",
                static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                static_cast<unsigned>(date.day()), static_cast<int>(clock.hours().count()),
                static_cast<int>(clock.minutes().count()),
                static_cast<int>(clock.seconds().count()));
  std::string result = text.data();
  if (moment.nanosecond != 0) {
    std::snprintf(text.data(), text.size(), ".%09u", moment.nanosecond);
    result += text.data();
  }
  return result + "Z";
}

} // namespace firetwin::run
