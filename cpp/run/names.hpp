#pragma once

#include <span>
#include <string>
#include <string_view>

namespace firetwin::run {

/// A field of a run, and the spellings of its unit; the first is the one that messages show.
struct FieldUnit {
  std::string_view field;
  std::span<const std::string_view> spellings;
};

/// Every field that a run may hold.
std::span<const FieldUnit> field_units();
const FieldUnit* find_field(std::string_view name);

/// The known name closest to `name` (Levenshtein distance at most 3), or "".
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known);

} // namespace firetwin::run
