#pragma once

#include <span>
#include <string>

namespace firetwin::run {

/// Refuses keys of more than eight parts: toml++ calls itself once per part, and the stack ends.
/// @throws InputError with line and column
void guard_toml(std::span<const char> text, const std::string& path);

} // namespace firetwin::run
