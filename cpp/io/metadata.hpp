#pragma once

#include <map>
#include <string>

namespace firetwin::io {

/// Metadata of a file: values by name.
using Metadata = std::map<std::string, std::string>;

} // namespace firetwin::io
