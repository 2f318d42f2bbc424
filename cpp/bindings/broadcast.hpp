#pragma once

#include "arrays.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <pybind11/stl.h>

#include <array>

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

/// An argument of a function of numbers, with its name for messages.
using Named = std::pair<pybind11::object, const char*>;

/// Applies a function from array<double, In> to array<double, Out> to arguments that broadcast;
/// returns a tuple of arrays of their common shape. Runs in parallel, without the GIL.
template <std::size_t Out, std::size_t In, class Function>
pybind11::tuple map_arrays(const std::array<Named, In>& arguments, const Function& function) {
  namespace py = pybind11;
  py::tuple given(In), results(Out);
  for (std::size_t k = 0; k < In; ++k) {
    given[k] = arguments[k].first;
  }
  const py::sequence same = py::module_::import("numpy").attr("broadcast_arrays")(*given);
  std::array<Array<double>, In> in;
  std::array<std::span<double>, Out> out;
  for (std::size_t k = 0; k < In; ++k) {
    in[k] = to_array<double>(same[k], arguments[k].second);
  }
  for (std::size_t k = 0; k < Out; ++k) {
    auto made = new_array<double>({in[0].shape(), in[0].shape() + in[0].ndim()});
    out[k] = writable(made);
    results[k] = made;
  }
  const py::gil_scoped_release release;
  tbb::parallel_for(std::size_t{0}, view(in[0]).size(), [&](std::size_t i) {
    std::array<double, In> values{};
    for (std::size_t k = 0; k < In; ++k) {
      values[k] = view(in[k])[i];
    }
    const std::array<double, Out> result = function(values);
    for (std::size_t k = 0; k < Out; ++k) {
      out[k][i] = result[k];
    }
  });
  return results;
}

} // namespace firetwin::bindings
