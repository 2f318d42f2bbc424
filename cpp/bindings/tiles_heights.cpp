#include "arrays.hpp"
#include "bindings.hpp"
#include "tiles/ground.hpp"
#include "tiles/height_map.hpp"

#include <pybind11/stl.h>

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

/// Returns ground heights and the surface class of each point.
py::tuple find_ground(const py::object& surface, double step, double max_width) {
  const auto array = to_array<float>(surface, "height", {-1, -1});
  const auto rows = static_cast<std::size_t>(array.shape(0)),
             columns = static_cast<std::size_t>(array.shape(1));
  tiles::GroundOptions options;
  options.step = step;
  options.max_width = max_width;
  tiles::Ground found;
  {
    const py::gil_scoped_release release;
    found = tiles::find_ground(view(array), rows, columns, options);
  }
  auto ground = new_array<float>({array.shape(0), array.shape(1)});
  auto classes = new_array<std::uint8_t>({array.shape(0), array.shape(1)});
  std::ranges::copy(found.height, writable(ground).begin());
  std::ranges::transform(found.surface_class, writable(classes).begin(),
                         [](tiles::SurfaceClass each) { return static_cast<std::uint8_t>(each); });
  return py::make_tuple(ground, classes);
}

} // namespace

void init_tiles_heights(Module module) {
  Class<HeightMap>(module, "HeightMap")
      .def(py::init<std::array<double, 2>, double, std::size_t, std::size_t>(), py::arg("low"),
           py::arg("step"), py::arg("rows"), py::arg("columns"))
      .def("add", &add, py::arg("position"), py::arg("origin"), py::arg("triangle"))
      .def_property_readonly("height", &height);
  module.def("find_ground", &find_ground, py::arg("height"), py::arg("step"),
             py::arg("max_width") = tiles::GroundOptions().max_width);
  module.attr("GROUND") = static_cast<int>(tiles::SurfaceClass::ground);
  module.attr("VEGETATION") = static_cast<int>(tiles::SurfaceClass::vegetation);
  module.attr("BUILDING") = static_cast<int>(tiles::SurfaceClass::building);
}

} // namespace firetwin::bindings
