#include "arrays.hpp"
#include "bindings.hpp"
#include "lod/levels.hpp"
#include "lod/select.hpp"

#include <pybind11/stl.h>

#include <memory>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using lod::Table;

/// A new array of the same shape.
template <class T> Array<T> like(const Array<double>& array) {
  return new_array<T>({array.shape(), array.shape() + array.ndim()});
}

Array<std::uint8_t> levels(const Table& table, const py::object& distance) {
  const auto d = to_array<double>(distance, "distance");
  auto result = like<std::uint8_t>(d);
  const auto out = writable(result);
  const py::gil_scoped_release release;
  table.levels(view(d), out);
  return result;
}

Array<double> multiplier(const Table& table, const py::object& distance) {
  const auto d = to_array<double>(distance, "distance");
  auto result = like<double>(d);
  const auto out = writable(result);
  const py::gil_scoped_release release;
  table.multiplier(view(d), out);
  return result;
}

Array<std::int64_t> select(const py::object& position, const py::object& camera,
                           py::ssize_t budget) {
  const auto points = to_array<double>(position, "position", {-1, 3});
  const auto cameras = to_array<double>(camera, "camera", {-1, 3});
  if (budget < 0) {
    wrong("budget", "must be 0 or more");
  }
  std::vector<std::int64_t> chosen;
  {
    const py::gil_scoped_release release;
    chosen = lod::select(view(points), view(cameras), static_cast<std::size_t>(budget));
  }
  const py::ssize_t n = length(chosen.size());
  return give(std::move(chosen), {n});
}

} // namespace

void init_lod(py::module_ module) {
  module.doc() = "What a shot can see: distance levels and nearest-first budgets.";
  py::class_<Table>(module, "Table", "Levels of detail by distance.")
      .def(py::init<std::vector<double>, std::vector<double>>(),
           py::arg("thresholds") = std::vector<double>{1500.0, 3500.0},
           py::arg("multipliers") = std::vector<double>{1.0, 0.7, 0.4})
      .def_property_readonly("thresholds", &Table::thresholds)
      .def_property_readonly("multipliers", &Table::multipliers)
      .def("levels", &levels, py::arg("distance"), "Level of each distance (m).")
      .def("multiplier", &multiplier, py::arg("distance"),
           "Particle multiplier of each distance (m).");
  module.def(
      "levels", [](const py::object& distance) { return levels(Table(), distance); },
      py::arg("distance"), "Level of each distance (m): <= 1500 -> 0, <= 3500 -> 1, else 2.");
  module.def("select", &select, py::arg("position"), py::arg("camera"), py::arg("budget"),
             "Indices of the `budget` positions (n, 3) nearest to any camera (m, 3).");
}

} // namespace firetwin::bindings
