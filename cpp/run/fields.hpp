#pragma once

#include <span>
#include <string_view>

namespace firetwin::run {

/// A field of a run and the accepted spellings of its unit; messages show the first one.
struct FieldUnit {
  std::string_view field;
  std::span<const std::string_view> spellings;
};

/// All fields that a run may contain.
std::span<const FieldUnit> field_units();
const FieldUnit* find_field(std::string_view name);

} // namespace firetwin::run
