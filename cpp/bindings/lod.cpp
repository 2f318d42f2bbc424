#include "arrays.hpp"
#include "bindings.hpp"
#include "broadcast.hpp"
#include "lod/level_table.hpp"
#include "lod/select_nearest.hpp"
#include "lod/visible_mask.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using lod::LevelTable;

/// Creates an array of the same shape.
template <class T> Array<T> like(const Array<double>& array) {
  return new_array<T>({array.shape(), array.shape() + array.ndim()});
}

Array<std::uint8_t> levels(const LevelTable& table, const py::object& distance) {
  const auto d = to_array<double>(distance, "distance");
  auto result = like<std::uint8_t>(d);
  const auto out = writable(result);
  const py::gil_scoped_release release;
  table.levels(view(d), out);
  return result;
}

Array<double> multiplier(const LevelTable& table, const py::object& distance) {
  const auto d = to_array<double>(distance, "distance");
  auto result = like<double>(d);
  const auto out = writable(result);
  const py::gil_scoped_release release;
  table.multiplier(view(d), out);
  return result;
}

Array<std::int64_t> select_nearest(const py::object& position, const py::object& camera,
                                   py::ssize_t budget) {
  const auto points = to_array<double>(position, "position", {-1, 3});
  const auto cameras = to_array<double>(camera, "camera", {-1, 3});
  if (budget < 0) {
    wrong("budget", "must be 0 or more");
  }
  std::vector<std::int64_t> chosen;
  {
    const py::gil_scoped_release release;
    chosen = lod::select_nearest(view(points), view(cameras), static_cast<std::size_t>(budget));
  }
  const py::ssize_t n = length(chosen.size());
  return give(std::move(chosen), {n});
}

std::shared_ptr<lod::Occluder> occluder(const py::object& position) {
  const auto nodes = to_array<double>(position, "position", {-1, -1, 3});
  const auto rows = static_cast<std::size_t>(nodes.shape(0));
  const auto columns = static_cast<std::size_t>(nodes.shape(1));
  const py::gil_scoped_release release;
  return std::make_shared<lod::Occluder>(view(nodes), rows, columns);
}

std::shared_ptr<lod::ViewSet>
view_set(const py::object& camera, const py::object& rotation, const py::object& half_extent,
         const py::object& sun, const py::object& orthographic, const py::object& above_terrain,
         std::shared_ptr<lod::Occluder> occluder, double lowest_terrain) {
  const auto cameras = to_array<double>(camera, "camera", {-1, 3});
  const py::ssize_t m = cameras.shape(0);
  const auto rotations = spread<double>(rotation, "rotation", {m, 3, 3});
  const auto halves = spread<double>(half_extent, "half_extent", {m, 2});
  const auto suns = spread<double>(sun, "sun", {m, 3});
  const auto parallels = spread<bool>(orthographic, "orthographic", {m});
  const auto clears = spread<bool>(above_terrain, "above_terrain", {m});
  std::vector<lod::View> views(static_cast<std::size_t>(m));
  for (std::size_t i = 0; i < views.size(); ++i) {
    lod::View& made = views[i];
    std::copy_n(cameras.data() + 3 * i, 3, made.position.begin());
    std::copy_n(rotations.data() + 9 * i, 9, made.to_world.begin());
    std::copy_n(suns.data() + 3 * i, 3, made.sun.begin());
    made.half_width = halves.data()[2 * i];
    made.half_height = halves.data()[2 * i + 1];
    made.orthographic = parallels.data()[i];
    made.above_terrain = clears.data()[i];
  }
  const py::gil_scoped_release release;
  return std::make_shared<lod::ViewSet>(std::move(views), std::move(occluder), lowest_terrain);
}

Array<bool> visible_mask(const py::object& position, const py::object& radius,
                         const lod::ViewSet& view_set, double max_distance, double margin,
                         bool shadows) {
  const auto centres = to_array<double>(position, "position", {-1, 3});
  const auto radii = spread<double>(radius, "radius", {centres.shape(0)});
  auto result = new_array<bool>({centres.shape(0)});
  const auto out = writable(result);
  const py::gil_scoped_release release;
  lod::visible_mask(view(centres), view(radii), view_set, {max_distance, margin, shadows}, out);
  return result;
}

Array<double> distance(const py::object& position, const lod::ViewSet& view_set) {
  const auto places = to_array<double>(position, "position", {-1, 3});
  auto result = new_array<double>({places.shape(0)});
  const auto out = writable(result);
  const py::gil_scoped_release release;
  lod::distance(view(places), view_set, out);
  return result;
}

} // namespace

void init_lod(Module module) {
  Class<LevelTable>(module, "LevelTable")
      .def(py::init<std::vector<double>, std::vector<double>>(),
           py::arg("thresholds") = std::vector<double>{1500.0, 3500.0},
           py::arg("multipliers") = std::vector<double>{1.0, 0.7, 0.4})
      .def_property_readonly("thresholds", &LevelTable::thresholds)
      .def_property_readonly("multipliers", &LevelTable::multipliers)
      .def("levels", &levels, py::arg("distance"))
      .def("multiplier", &multiplier, py::arg("distance"));
  module.def(
      "levels", [](const py::object& distance) { return levels(LevelTable(), distance); },
      py::arg("distance"));
  module.def("select_nearest", &select_nearest, py::arg("position"), py::arg("camera"),
             py::arg("budget"));
  Class<lod::Occluder, std::shared_ptr<lod::Occluder>>(module, "Occluder")
      .def(py::init(&occluder), py::arg("position"));
  Class<lod::ViewSet, std::shared_ptr<lod::ViewSet>>(module, "ViewSet")
      .def(py::init(&view_set), py::arg("camera"), py::arg("rotation"), py::arg("half_extent"),
           py::arg("sun") = Vector{}, py::arg("orthographic") = false,
           py::arg("above_terrain") = true, py::arg("occluder") = py::none(),
           py::arg("lowest_terrain") = 0.0);
  module.def("visible_mask", &visible_mask, py::arg("position"), py::arg("radius"),
             py::arg("views"), py::arg("max_distance") = std::numeric_limits<double>::infinity(),
             py::arg("margin") = 0.0, py::arg("shadows") = false);
  module.def("distance", &distance, py::arg("position"), py::arg("views"));
}

} // namespace firetwin::bindings
