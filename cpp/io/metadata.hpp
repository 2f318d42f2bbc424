#pragma once

#include <map>
#include <string>

namespace firetwin::io {

/// What a file says of itself: texts by name.
using Metadata = std::map<std::string, std::string>;

} // namespace firetwin::io
