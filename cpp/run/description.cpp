#include "run/description.hpp"

#include "io/file.hpp"
#include "io/name.hpp"
#include "run/fields.hpp"
#include "run/iso_time.hpp"
#include "run/spelling.hpp"
#include "run/toml.hpp"
#include "run/toml_guard.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace firetwin::run {
namespace {

constexpr std::uint64_t largest_description = 16U << 20;
/// s, 12 days: beyond it the resolution of 32-bit floats is coarser than 1/16 s.
constexpr double far_from_start = 1.0e6;
constexpr double longest = 5.0e11; ///< s, more than the range of dates
constexpr std::array<std::string_view, 12> known_keys = {
    "name",  "start",   "interval_s", "times_s", "mean_s", "vertical",
    "units", "no_data", "synthetic",  "event",   "source", "zone"};

Moment moment_of(const toml::date_time& t) {
  return {t.date.year,   t.date.month,  t.date.day,        t.time.hour,
          t.time.minute, t.time.second, t.time.nanosecond, t.offset->minutes};
}

class Reader {
public:
  Reader(const toml::table& table, const std::filesystem::path& path)
      : table_(table), path_(path) {}

  Description read() {
    check_keys();
    Description m;
    m.name = text("name", io::utf8(path_.parent_path().filename()));
    m.start = start(m.offset);
    m.zone = text("zone", "");
    m.vertical = vertical(m);
    m.event = text("event", "");
    if (const toml::node* node = table_.get("synthetic")) {
      m.synthetic = value<bool>(*node, "synthetic must be true or false");
    }
    if (const toml::node* node = table_.get("no_data")) {
      m.no_data = number(*node, "no_data must be a number");
    }
    if (const toml::node* node = table_.get("source"); node && !node->is_table()) {
      fail(node->source(), "source must be a table that describes the origin of the run");
    }
    if (const toml::node* node = table_.get("mean_s")) {
      const std::string form = "mean_s must be a number of seconds, 0 for fluxes at their time";
      m.mean_s = number(*node, form);
      if (*m.mean_s < 0.0) {
        fail(node->source(), form);
      }
    }
    read_times(m);
    check_units();
    return m;
  }

private:
  void check_keys() const {
    for (const auto& [key, node] : table_) {
      const std::string_view name = key.str();
      if (std::find(known_keys.begin(), known_keys.end(), name) == known_keys.end()) {
        fail(key.source(), unknown("key", name, known_keys));
      }
    }
  }

  static std::string unknown(const std::string& kind, std::string_view name,
                             std::span<const std::string_view> known) {
    const std::string_view nearest = nearest_name(name, known);
    return "unknown " + kind + " '" + std::string(name) + "'; " +
           (nearest.empty() ? "remove it" : "did you mean '" + std::string(nearest) + "'?");
  }

  std::string text(const char* key, std::string otherwise) const {
    const toml::node* node = table_.get(key);
    return node ? value<std::string>(*node, std::string(key) + " must be a text in quotes")
                : std::move(otherwise);
  }

  /// Start in UTC; `offset` receives its offset from UTC.
  std::string start(int& offset) const {
    const toml::node* node = table_.get("start");
    const std::string form = "start must be a date and time with its offset from UTC, like "
                             "2014-09-17T04:45:00Z";
    if (!node) {
      fail({}, form + "; add it");
    }
    const auto moment = start_moment(*node);
    const auto text = moment ? utc_text(*moment) : std::nullopt;
    if (!text) {
      fail(node->source(), form);
    }
    offset = moment->offset;
    return *text;
  }

  /// Parses a TOML date-time or a string; empty for other values.
  static std::optional<Moment> start_moment(const toml::node& node) {
    if (const auto text = node.value_exact<std::string_view>()) {
      return parse_iso(*text);
    }
    const auto time = node.value_exact<toml::date_time>();
    return time && time->offset ? std::optional(moment_of(*time)) : std::nullopt;
  }

  std::string vertical(Description& m) const {
    const toml::node* node = table_.get("vertical");
    if (!node) {
      m.warnings.push_back("run.toml gives no vertical reference; vertical = "
                           "\"orthometric\" (above sea level) is assumed");
      return "orthometric";
    }
    const std::string form = "vertical must be \"orthometric\" or \"ellipsoidal\"";
    std::string vertical = value<std::string>(*node, form);
    if (vertical != "orthometric" && vertical != "ellipsoidal") {
      fail(node->source(), form);
    }
    return vertical;
  }

  void read_times(Description& m) const {
    const toml::node* interval = table_.get("interval_s");
    const toml::node* times = table_.get("times_s");
    if (!interval == !times) {
      fail(interval ? interval->source() : toml::source_region{},
           "exactly one of interval_s (seconds between model times) and times_s (a list of "
           "seconds since start) is needed");
    }
    if (interval) {
      m.interval_s = number(*interval, "interval_s must be a number of seconds above 0");
      if (!(*m.interval_s > 0.0)) {
        fail(interval->source(), "interval_s must be a number of seconds above 0");
      }
      return;
    }
    const std::string form = "times_s must be a list of strictly ascending seconds since start";
    const toml::array* list = times->as_array();
    if (!list || list->empty()) {
      fail(times->source(), form);
    }
    for (const toml::node& node : *list) {
      const double time = number(node, form);
      if (!m.times_s.empty() && !(time > m.times_s.back())) {
        fail(node.source(), form + "; sort the times and the frames, and remove duplicates");
      }
      m.times_s.push_back(time);
    }
    count_from_near(m);
  }

  /// Moves the start to a full second near the first time if that is far from the start.
  static void count_from_near(Description& m) {
    const double zero = std::floor(m.times_s.front());
    const auto start = parse_iso(m.start);
    if (std::abs(zero) < far_from_start || std::abs(zero) > longest || !start) {
      return;
    }
    std::vector<double> times = m.times_s;
    for (double& time : times) {
      time -= zero;
    }
    const bool ascend = std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) ==
                        times.end(); // false if times are so large that they round to equal values
    auto later = utc_text(*start, static_cast<std::int64_t>(zero));
    if (ascend && later) {
      m.start = std::move(*later);
      m.zero_s = zero;
      m.times_s = std::move(times);
    }
  }

  void check_units() const {
    const toml::node* node = table_.get("units");
    if (!node) {
      return;
    }
    const toml::table* units = node->as_table();
    if (!units) {
      fail(node->source(), "units must be a table of field = \"unit\"");
    }
    std::vector<std::string_view> names;
    for (const FieldUnit& f : field_units()) {
      names.push_back(f.field);
    }
    for (const auto& [key, unit] : *units) {
      const FieldUnit* field = find_field(key.str());
      if (!field) {
        fail(key.source(), unknown("field", key.str(), names));
      }
      const auto given = value<std::string>(unit, "a unit must be a text in quotes");
      if (std::find(field->spellings.begin(), field->spellings.end(), given) ==
          field->spellings.end()) {
        fail(unit.source(), std::string(key.str()) + " is in '" + given + "' but must be in '" +
                                std::string(field->spellings.front()) +
                                "'; convert the field and change the unit here");
      }
    }
  }

  double number(const toml::node& node, const std::string& reason) const {
    if (!node.is_number()) {
      fail(node.source(), reason);
    }
    const double number = *node.value<double>();
    if (!std::isfinite(number)) {
      fail(node.source(), reason);
    }
    return number;
  }

  template <class T> T value(const toml::node& node, const std::string& reason) const {
    const auto found = node.value_exact<T>();
    if (!found) {
      fail(node.source(), reason);
    }
    return *found;
  }

  [[noreturn]] void fail(const toml::source_region& place, const std::string& reason) const {
    io::fail(path_, place.begin.line, place.begin.column, reason);
  }

  const toml::table& table_;
  const std::filesystem::path& path_;
};

} // namespace

Description read_description(const std::filesystem::path& path) {
  const Buffer<char> bytes = io::read_all(path, largest_description);
  toml::table table;
  try {
    guard_toml(bytes, io::utf8(path));
    table = toml::parse(std::string_view(bytes.data(), bytes.size()), io::utf8(path));
  } catch (const toml::parse_error& e) {
    const auto& place = e.source().begin;
    io::fail(path, place.line, place.column, "is not valid TOML: " + std::string(e.description()));
  }
  return Reader(table, path).read();
}

} // namespace firetwin::run
