#include "arrays.hpp"
#include "bindings.hpp"
#include "forest/allometry.hpp"
#include "forest/stand.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using forest::Plants;
using geo::LocalFrame;

/// Two Python types of the same data: trees and grass.
struct Trees : Plants {};
struct Grass : Plants {};
using forest::Stems;

/// Owns the arrays of a PlantingSite; checks their shapes against the fuel.
struct SiteArrays {
  Array<double> latitude;
  Array<double> longitude;
  Array<float> elevation;
  Array<bool> mask;

  SiteArrays(const Array<float>& fuel, const py::object& lat, const py::object& lon,
             const py::object& height, const py::object& cells)
      : latitude(to_array<double>(lat, "latitude", {fuel.shape(0)})),
        longitude(to_array<double>(lon, "longitude", {fuel.shape(1)})),
        elevation(to_array<float>(height, "elevation", {fuel.shape(0), fuel.shape(1)})) {
    if (!cells.is_none()) {
      mask = to_array<bool>(cells, "mask", {fuel.shape(0), fuel.shape(1)});
    }
  }

  forest::PlantingSite site(const LocalFrame& frame, std::uint64_t seed, double jitter) const {
    return {view(latitude), view(longitude), view(elevation), &frame, seed, jitter, view(mask)};
  }
};

std::shared_ptr<Trees> trees(const py::object& canopy_fuel, const py::object& latitude,
                             const py::object& longitude, const py::object& elevation,
                             const LocalFrame& frame, std::uint64_t seed,
                             std::optional<double> max_fuel, double jitter,
                             const py::object& mask) {
  const auto fuel = to_array<float>(canopy_fuel, "canopy_fuel", {-1, -1});
  const SiteArrays arrays(fuel, latitude, longitude, elevation, mask);
  const auto site = arrays.site(frame, seed, jitter);
  const py::gil_scoped_release release;
  if (!max_fuel) {
    // Without canopy fuel the maximum is not needed, as no tree grows.
    const double largest = double{forest::largest_fuel(view(fuel))};
    max_fuel = largest > 0.0 ? largest : 1.0;
  }
  return std::make_shared<Trees>(Trees{forest::trees(view(fuel), site, *max_fuel)});
}

std::shared_ptr<Grass> grass(const py::object& surface_fuel, const py::object& latitude,
                             const py::object& longitude, const py::object& elevation,
                             const LocalFrame& frame, std::uint64_t seed, double jitter,
                             const py::object& mask) {
  const auto fuel = to_array<float>(surface_fuel, "surface_fuel", {-1, -1});
  const SiteArrays arrays(fuel, latitude, longitude, elevation, mask);
  const auto site = arrays.site(frame, seed, jitter);
  const py::gil_scoped_release release;
  return std::make_shared<Grass>(Grass{forest::grass(view(fuel), site)});
}

std::shared_ptr<Stems> stand(const py::object& canopy_fuel, const py::object& latitude,
                             const py::object& longitude, const py::object& elevation,
                             const LocalFrame& frame, std::uint64_t seed,
                             const py::object& retained, const py::object& mask) {
  const auto fuel = to_array<float>(canopy_fuel, "canopy_fuel", {-1, -1});
  const SiteArrays arrays(fuel, latitude, longitude, elevation, mask);
  Array<float> part;
  if (!retained.is_none()) {
    part = to_array<float>(retained, "retained", {fuel.shape(0), fuel.shape(1)});
  }
  const auto site = arrays.site(frame, seed, 1.0);
  const py::gil_scoped_release release;
  return std::make_shared<Stems>(forest::stand(view(fuel), site, view(part)));
}

Array<double> stems(const py::object& canopy_fuel) {
  const auto fuel = to_array<double>(canopy_fuel, "canopy_fuel");
  Array<double> out(std::vector<py::ssize_t>(fuel.shape(), fuel.shape() + fuel.ndim()));
  const auto from = view(fuel);
  std::transform(from.begin(), from.end(), out.mutable_data(), &forest::stems);
  return out;
}

template <class T> Array<T> lend_buffer(const Buffer<T>& values, const py::object& owner) {
  return lend<T>(values, {length(values.size())}, owner);
}

template <class T, auto member> auto column(const py::object& self) {
  return lend_buffer(self.cast<const T&>().*member, self);
}

template <class T> Array<double> position(const py::object& self) {
  const auto& plants = self.cast<const T&>();
  return lend<double>(plants.position, {length(plants.cell.size()), 3}, self);
}

template <class T> auto bind_plants(Module& module, const char* name) {
  return Class<T, std::shared_ptr<T>>(module, name)
      .def_property_readonly("cell", &column<T, &T::cell>)
      .def_property_readonly("position", &position<T>)
      .def_property_readonly("scale", &column<T, &T::scale>)
      .def_property_readonly("rotation", &column<T, &T::rotation>)
      .def("__len__", [](const T& plants) { return plants.cell.size(); });
}

} // namespace

void init_forest(Module module) {
  module.attr("SMALL") = static_cast<int>(forest::small_tree);
  module.attr("MEDIUM") = static_cast<int>(forest::medium_tree);
  module.attr("LARGE") = static_cast<int>(forest::large_tree);
  bind_plants<Trees>(module, "Trees")
      .def_property_readonly("size_class", &column<Trees, &Trees::size_class>)
      .def_property_readonly("model", &column<Trees, &Trees::model>);
  bind_plants<Grass>(module, "Grass");
  bind_plants<Stems>(module, "Stems")
      .def_property_readonly("size_class", &column<Stems, &Stems::size_class>)
      .def_property_readonly("model", &column<Stems, &Stems::model>)
      .def_property_readonly("width", &column<Stems, &Stems::width>)
      .def_property_readonly("key", &column<Stems, &Stems::key>);
  module.def("stems", &stems, py::arg("canopy_fuel"));
  module.def("stand", &stand, py::arg("canopy_fuel"), py::arg("latitude"), py::arg("longitude"),
             py::arg("elevation"), py::arg("frame"), py::arg("seed") = 0,
             py::arg("retained") = py::none(), py::arg("mask") = py::none());
  module.def("trees", &trees, py::arg("canopy_fuel"), py::arg("latitude"), py::arg("longitude"),
             py::arg("elevation"), py::arg("frame"), py::arg("seed") = 0,
             py::arg("max_fuel") = py::none(), py::arg("jitter") = 1.0,
             py::arg("mask") = py::none());
  module.def("grass", &grass, py::arg("surface_fuel"), py::arg("latitude"), py::arg("longitude"),
             py::arg("elevation"), py::arg("frame"), py::arg("seed") = 0, py::arg("jitter") = 1.0,
             py::arg("mask") = py::none());
}

} // namespace firetwin::bindings
