#pragma once

#include <span>
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

} // namespace firetwin::run
