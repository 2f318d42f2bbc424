#pragma once

#include <span>
#include <string_view>

namespace firetwin::bindings {

struct Docstring {
  std::string_view name; ///< within the module, such as "flux.Emitters.cell"
  const char* text;
};

/// Returns the docstrings of the stubs, sorted by name. documentation.py generates the table.
std::span<const Docstring> documentation_table();

} // namespace firetwin::bindings
