#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <type_traits>
#include <utility>

/// Docstrings at run time: the stubs are their only source (documentation.py). Module and Class
/// bind like pybind11's, and look up the docstring by the bound name.
namespace firetwin::bindings {

/// Returns the docstring of a name; special methods may have none.
/// @throws std::logic_error if the stubs do not have the name, so that the module cannot be
/// imported
const char* documentation(const std::string& name);

/// True if the arguments of a binding contain no docstring.
template <class... Extra>
constexpr bool without_text = (!std::is_convertible_v<const Extra&, const char*> && ...);

/// A module whose functions and classes have the stubs' docstrings.
class Module : public pybind11::module_ {
public:
  Module(const pybind11::module_& module); // implicit, for def_submodule

  /// Prefix of names, such as "flux."; empty for the top module.
  const std::string& scope() const { return scope_; }

  template <class Function, class... Extra>
  Module& def(const char* name, Function&& function, const Extra&... extra) {
    static_assert(without_text<Extra...>, "write the docstring into the stub");
    module_::def(name, std::forward<Function>(function), extra..., documentation(scope_ + name));
    return *this;
  }

private:
  std::string scope_;
};

/// A class whose members have the stubs' docstrings.
template <class T, class... Options> class Class : public pybind11::class_<T, Options...> {
  using Base = pybind11::class_<T, Options...>;

public:
  Class(const Module& module, const char* name)
      : Base(module, name, documentation(module.scope() + name)),
        scope_(module.scope() + name + ".") {}

  template <class Function, class... Extra>
  Class& def(const char* name, Function&& function, const Extra&... extra) {
    static_assert(without_text<Extra...>, "write the docstring into the stub");
    Base::def(name, std::forward<Function>(function), extra..., documentation(scope_ + name));
    return *this;
  }

  /// Binds a constructor.
  template <class Init, class... Extra>
    requires(!std::is_convertible_v<Init, const char*>)
  Class& def(Init&& init, const Extra&... extra) {
    static_assert(without_text<Extra...>, "write the docstring into the stub");
    Base::def(std::forward<Init>(init), extra..., documentation(scope_ + "__init__"));
    return *this;
  }

  template <class Getter> Class& def_property_readonly(const char* name, const Getter& getter) {
    Base::def_property_readonly(name, getter, documentation(scope_ + name));
    return *this;
  }

  template <class Member> Class& def_readonly(const char* name, Member T::* member) {
    Base::def_readonly(name, member, documentation(scope_ + name));
    return *this;
  }

private:
  std::string scope_;
};

} // namespace firetwin::bindings
