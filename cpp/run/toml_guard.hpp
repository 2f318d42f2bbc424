#pragma once

#include <span>
#include <string>

namespace firetwin::run {

/// Rejects keys of more than eight parts: toml++ recurses once per part and overflows the stack.
/// @throws InputError with line and column
void guard_toml(std::span<const char> text, const std::string& path);

} // namespace firetwin::run
