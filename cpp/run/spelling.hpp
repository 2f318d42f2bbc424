#pragma once

#include <span>
#include <string_view>

namespace firetwin::run {

/// The known name closest to `name` (Levenshtein distance at most 3), or "".
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known);

} // namespace firetwin::run
