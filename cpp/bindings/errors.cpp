#include "base/error.hpp"
#include "bindings.hpp"

#include <pybind11/gil_safe_call_once.h>

#include <exception>
#include <string>

namespace firetwin::bindings {
namespace py = pybind11;

py::str readable(const std::string& bytes) {
  PyObject* decoded = PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()),
                                           "backslashreplace");
  if (decoded == nullptr) {
    throw py::error_already_set();
  }
  return py::reinterpret_steal<py::str>(decoded);
}

void init_errors(Module& module) {
  PYBIND11_CONSTINIT static py::gil_safe_call_once_and_store<py::object> error;
  PYBIND11_CONSTINIT static py::gil_safe_call_once_and_store<py::object> input_error;
  error.call_once_and_store_result(
      [&] { return py::object(py::exception<Error>(module, "Error")); });
  input_error.call_once_and_store_result([&] {
    return py::object(py::exception<InputError>(module, "InputError", error.get_stored()));
  });
  error.get_stored().attr("__doc__") = documentation("Error");
  input_error.get_stored().attr("__doc__") = documentation("InputError");
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) {
        std::rethrow_exception(pointer);
      }
    } catch (const InputError& e) {
      const py::object& type = input_error.get_stored();
      py::object value = type(readable(e.what()));
      value.attr("path") = readable(e.path());
      value.attr("line") = e.line();
      value.attr("column") = e.column();
      value.attr("reason") = readable(e.reason());
      PyErr_SetObject(type.ptr(), value.ptr());
    } catch (const Error& e) {
      py::set_error(error.get_stored(), readable(e.what()));
    }
  });
}

} // namespace firetwin::bindings
