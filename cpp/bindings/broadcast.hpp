#pragma once

#include "arrays.hpp"

#include <pybind11/stl.h>

namespace firetwin::bindings {

/// Makes a new array of this shape from anything that broadcasts to it.
template <class T>
Array<T> spread(const pybind11::object& object, const std::string& name,
                const std::vector<pybind11::ssize_t>& shape) {
  namespace py = pybind11;
  const auto array = to_array<T>(object, name);
  const auto numpy = py::module_::import("numpy");
  try {
    return py::array_t < T,
           py::array::c_style | py::array::forcecast >
                                    (numpy.attr("array")(numpy.attr("broadcast_to")(array, shape)));
  } catch (py::error_already_set& e) {
    if (!e.matches(PyExc_ValueError)) {
      throw;
    }
  }
  wrong(name, "must have or broadcast to shape " +
                  py::str(py::tuple(py::cast(shape))).cast<std::string>() + ", not " +
                  shape_text(array));
}

} // namespace firetwin::bindings
