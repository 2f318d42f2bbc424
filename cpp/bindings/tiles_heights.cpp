#include "arrays.hpp"
#include "bindings.hpp"
#include "tiles/height_map.hpp"

#include <algorithm>
#include <array>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using tiles::HeightMap;

void add(HeightMap& map, const py::object& position, const std::array<double, 3>& origin,
         const py::object& triangle) {
  const auto places = to_array<float>(position, "position", {-1, 3});
  const auto corners = to_array<std::uint32_t>(triangle, "triangle", {-1, 3});
  const py::gil_scoped_release release;
  map.add(view(places), origin, view(corners));
}

Array<float> height(const HeightMap& map) {
  auto result = new_array<float>(
      {static_cast<py::ssize_t>(map.rows()), static_cast<py::ssize_t>(map.columns())});
  std::ranges::copy(map.height(), writable(result).begin());
  return result;
}

} // namespace

void init_tiles_heights(Module module) {
  Class<HeightMap>(module, "HeightMap")
      .def(py::init<std::array<double, 2>, double, std::size_t, std::size_t>(), py::arg("low"),
           py::arg("step"), py::arg("rows"), py::arg("columns"))
      .def("add", &add, py::arg("position"), py::arg("origin"), py::arg("triangle"))
      .def_property_readonly("height", &height);
}

} // namespace firetwin::bindings
