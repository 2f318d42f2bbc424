#include "arrays.hpp"
#include "bindings.hpp"
#include "broadcast.hpp"
#include "lod/pool.hpp"
#include "lod/select.hpp"
#include "lod/table.hpp"
#include "lod/visible.hpp"
#include "views.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <limits>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using lod::Table;

/// A new array of the same shape.
template <class T> Array<T> like(const Array<double>& array) {
  return new_array<T>({array.shape(), array.shape() + array.ndim()});
}

Array<std::uint8_t> details(const Table& table, const py::object& distance) {
  const auto d = to_array<double>(distance, "distance");
  auto result = like<std::uint8_t>(d);
  const auto out = writable(result);
  const py::gil_scoped_release release;
  table.details(view(d), out);
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

Array<std::int32_t> seen(const py::object& position, const py::object& radius,
                         const py::object& camera, const py::object& rotation,
                         const py::object& fov, double near, double far, double margin,
                         const geo::HeightField* ground) {
  const auto centres = to_array<double>(position, "position", {-1, 3});
  const auto radii = spread<double>(radius, "radius", {centres.shape(0)});
  const std::vector<lod::View> path = views(camera, rotation, fov);
  std::vector<std::int32_t> frames;
  {
    const py::gil_scoped_release release;
    frames = lod::seen(view(centres), view(radii), path, {near, far, margin, ground});
  }
  return give(std::move(frames), {centres.shape(0), 2});
}

Array<std::int32_t> assign(lod::Pool& pool, const py::object& cell) {
  const auto cells = to_array<std::int64_t>(cell, "cell", {-1});
  auto slots = pool.assign(view(cells));
  return give(std::move(slots), {cells.size()});
}

Array<std::uint32_t> seeds(const lod::Pool& pool, const py::object& cell) {
  const auto cells = to_array<std::int64_t>(cell, "cell");
  Array<std::uint32_t> result =
      new_array<std::uint32_t>({cells.shape(), cells.shape() + cells.ndim()});
  const auto in = view(cells);
  std::transform(in.begin(), in.end(), writable(result).begin(),
                 [&pool](std::int64_t c) { return pool.seed(c); });
  return result;
}

Array<std::int64_t> held(const lod::Pool& pool) {
  return give(std::vector<std::int64_t>(pool.cells().begin(), pool.cells().end()),
              {length(pool.capacity())});
}

} // namespace

void init_lod(Module module) {
  Class<Table>(module, "Table")
      .def(py::init<std::vector<double>, std::vector<double>>(),
           py::arg("thresholds") = std::vector<double>{1500.0, 3500.0},
           py::arg("multipliers") = std::vector<double>{1.0, 0.7, 0.4})
      .def_property_readonly("thresholds", &Table::thresholds)
      .def_property_readonly("multipliers", &Table::multipliers)
      .def("levels", &details, py::arg("distance"))
      .def("multiplier", &multiplier, py::arg("distance"));
  module.def(
      "levels", [](const py::object& distance) { return details(Table(), distance); },
      py::arg("distance"));
  module.def("select", &select, py::arg("position"), py::arg("camera"), py::arg("budget"));
  module.def("seen", &seen, py::arg("position"), py::arg("radius"), py::arg("camera"),
             py::arg("rotation"), py::arg("fov"), py::arg("near") = 0.1,
             py::arg("far") = std::numeric_limits<double>::infinity(), py::arg("margin") = 1.0,
             py::arg("ground") = py::none());
  Class<lod::Pool>(module, "Pool")
      .def(py::init<std::size_t, std::uint64_t>(), py::arg("capacity"), py::arg("seed") = 0)
      .def_property_readonly("capacity", &lod::Pool::capacity)
      .def_property_readonly("cells", &held)
      .def("assign", &assign, py::arg("cell"))
      .def("seeds", &seeds, py::arg("cell"));
}

} // namespace firetwin::bindings
