#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// NumPy arrays as arguments and results: arguments are checked and converted, results are returned
/// without a copy.
namespace firetwin::bindings {

/// C-contiguous array of T.
template <class T> using Array = pybind11::array_t<T, pybind11::array::c_style>;

[[noreturn]] inline void wrong(const std::string& name, const std::string& what) {
  throw pybind11::value_error(name + " " + what);
}

inline std::string shape_text(const pybind11::array& array) {
  return pybind11::str(array.attr("shape")).cast<std::string>();
}

/// Returns whether every value of an integer array fits into type T.
template <class T> bool fits(const pybind11::array& array) {
  namespace py = pybind11;
  const py::module_ numpy = py::module_::import("numpy");
  const py::dtype wanted = py::dtype::of<T>();
  if (array.size() == 0 || numpy.attr("can_cast")(array.dtype(), wanted).template cast<bool>()) {
    return true;
  }
  const py::object limits = numpy.attr("iinfo")(wanted);
  const auto python = py::module_::import("builtins").attr("int");
  return python(array.attr("min")()) >= limits.attr("min") &&
         python(array.attr("max")()) <= limits.attr("max");
}

/// Converts array-likes of real numbers to contiguous T. Rejects text, complex numbers and objects;
/// for integer T also fractions and values beyond its range.
template <class T> Array<T> to_array(const pybind11::handle& object, const std::string& name) {
  namespace py = pybind11;
  const py::array any = py::array::ensure(object);
  if (!any) {
    PyErr_Clear();
    wrong(name, "is not an array of numbers");
  }
  const char kind = any.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u' && kind != 'b') {
    wrong(name, "must contain real numbers, not " + py::str(any.dtype()).cast<std::string>());
  }
  if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
    if (any.size() > 0 && kind == 'f') { // an empty list is converted to floats
      wrong(name, "must contain integers, not " + py::str(any.dtype()).cast<std::string>());
    }
    if (!fits<T>(any)) {
      wrong(name, "contains an integer out of range for " +
                      py::str(py::dtype::of<T>()).cast<std::string>());
    }
  }
  return py::array_t < T, py::array::c_style | py::array::forcecast > (any);
}

/// Also requires a shape; -1 accepts any length.
template <class T>
Array<T> to_array(const pybind11::handle& object, const std::string& name,
                  const std::vector<pybind11::ssize_t>& shape) {
  Array<T> array = to_array<T>(object, name);
  bool same = array.ndim() == static_cast<pybind11::ssize_t>(shape.size());
  std::string expected;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const auto axis = static_cast<pybind11::ssize_t>(i);
    same = same && (shape[i] < 0 || array.shape(axis) == shape[i]);
    expected += (i ? ", " : "") + (shape[i] < 0 ? std::string("any") : std::to_string(shape[i]));
  }
  if (!same) {
    wrong(name, "must have shape (" + expected + "), not " + shape_text(array));
  }
  return array;
}

template <class T> std::span<const T> view(const Array<T>& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

/// Makes a new array.
template <class T> Array<T> new_array(std::vector<pybind11::ssize_t> shape) {
  return Array<T>(std::move(shape));
}
template <class T> std::span<T> writable(Array<T>& array) {
  return {array.mutable_data(), static_cast<std::size_t>(array.size())};
}

/// Makes a NumPy array of zeros (float32), which uses no memory until it is written to.
inline Array<float> zeros(const std::vector<pybind11::ssize_t>& shape) {
  namespace py = pybind11;
  return py::module_::import("numpy").attr("zeros")(shape, "float32").cast<Array<float>>();
}

/// Transfers a vector's memory to NumPy.
template <class T> Array<T> give(std::vector<T>&& values, std::vector<pybind11::ssize_t> shape) {
  auto owner = std::make_unique<std::vector<T>>(std::move(values));
  T* data = owner->data();
  const pybind11::capsule capsule(owner.get(),
                                  [](void* p) { delete static_cast<std::vector<T>*>(p); });
  owner.release();
  return Array<T>(std::move(shape), data, capsule);
}

/// Makes a read-only view of memory that `owner` keeps alive.
template <class T>
Array<T> lend(std::span<const T> values, std::vector<pybind11::ssize_t> shape,
              const pybind11::handle& owner) {
  Array<T> array(std::move(shape), values.data(), owner);
  array.attr("setflags")(pybind11::arg("write") = false);
  return array;
}

template <class T>
Array<T> lend_column(const std::vector<T>& values, const pybind11::handle& owner) {
  return lend<T>(values, {static_cast<pybind11::ssize_t>(values.size())}, owner);
}

inline pybind11::ssize_t length(std::size_t size) {
  return static_cast<pybind11::ssize_t>(size);
}

} // namespace firetwin::bindings
