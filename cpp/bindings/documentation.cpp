#include "documentation.hpp"

#include "documentation_table.hpp"

#include <algorithm>
#include <stdexcept>

namespace firetwin::bindings {
namespace {

/// "firetwin_core.flux" -> "flux", "firetwin_core" -> "".
std::string inner_name(const pybind11::module_& module) {
  const auto name = module.attr("__name__").cast<std::string>();
  const auto point = name.find('.');
  return point == std::string::npos ? "" : name.substr(point + 1);
}

bool is_special(const std::string& name) {
  const auto point = name.rfind('.');
  return name.compare(point == std::string::npos ? 0 : point + 1, 2, "__") == 0;
}

} // namespace

const char* documentation(const std::string& name) {
  const auto table = documentation_table();
  const auto found = std::ranges::lower_bound(table, name, {}, &Docstring::name);
  if (found != table.end() && found->name == name) {
    return found->text;
  }
  if (is_special(name)) {
    return "";
  }
  throw std::logic_error(name +
                         " is bound but has no stub; add it with its docstring to the stubs");
}

Module::Module(const pybind11::module_& module) : pybind11::module_(module) {
  scope_ = inner_name(module);
  doc() = documentation(scope_);
  scope_ += scope_.empty() ? "" : ".";
}

} // namespace firetwin::bindings
