#include "arrays.hpp"
#include "bindings.hpp"
#include "geo/height_field.hpp"
#include "geo/local_frame.hpp"

#include <memory>
#include <tuple>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using geo::HeightField;
using geo::LocalFrame;

Array<double> forward(const LocalFrame& frame, const py::object& latitude,
                      const py::object& longitude, const py::object& height) {
  const auto lat = to_array<double>(latitude, "latitude", {-1});
  const auto lon = to_array<double>(longitude, "longitude", {lat.size()});
  const auto h = to_array<double>(height, "height", {lat.size()});
  auto enu = new_array<double>({lat.size(), 3});
  const auto out = writable(enu);
  const py::gil_scoped_release release;
  frame.forward(view(lat), view(lon), view(h), out);
  return enu;
}

Array<double> forward_grid(const LocalFrame& frame, const py::object& latitude,
                           const py::object& longitude, const py::object& height) {
  const auto lat = to_array<double>(latitude, "latitude", {-1});
  const auto lon = to_array<double>(longitude, "longitude", {-1});
  const auto h = to_array<double>(height, "height", {lat.size(), lon.size()});
  auto enu = new_array<double>({lat.size(), lon.size(), 3});
  const auto out = writable(enu);
  const py::gil_scoped_release release;
  frame.forward_grid(view(lat), view(lon), view(h), out);
  return enu;
}

std::tuple<Array<double>, Array<double>, Array<double>> reverse(const LocalFrame& frame,
                                                                const py::object& enu) {
  const auto points = to_array<double>(enu, "enu", {-1, 3});
  auto lat = new_array<double>({points.shape(0)});
  auto lon = new_array<double>({points.shape(0)});
  auto h = new_array<double>({points.shape(0)});
  const auto lat_out = writable(lat), lon_out = writable(lon), h_out = writable(h);
  {
    const py::gil_scoped_release release;
    frame.reverse(view(points), lat_out, lon_out, h_out);
  }
  return {lat, lon, h};
}

std::shared_ptr<HeightField> height_field(const py::object& x, const py::object& y,
                                          const py::object& height) {
  const auto columns = to_array<double>(x, "x", {-1});
  const auto rows = to_array<double>(y, "y", {-1});
  const auto h = to_array<float>(height, "height", {rows.size(), columns.size()});
  const py::gil_scoped_release release;
  return std::make_shared<HeightField>(view(columns), view(rows), view(h));
}

Array<double> height_at(const HeightField& field, const py::object& place) {
  const auto places = to_array<double>(place, "place", {-1, 2});
  auto result = new_array<double>({places.shape(0)});
  const auto out = writable(result);
  const auto in = view(places);
  const py::gil_scoped_release release;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = field.at(in[2 * i], in[2 * i + 1]);
  }
  return result;
}

} // namespace

void init_geo(Module module) {
  Class<LocalFrame>(module, "LocalFrame")
      .def(py::init<double, double, double>(), py::arg("latitude"), py::arg("longitude"),
           py::arg("height") = 0.0)
      .def_property_readonly("latitude", &LocalFrame::latitude)
      .def_property_readonly("longitude", &LocalFrame::longitude)
      .def_property_readonly("height", &LocalFrame::height)
      .def("forward", &forward, py::arg("latitude"), py::arg("longitude"), py::arg("height"))
      .def("forward_grid", &forward_grid, py::arg("latitude"), py::arg("longitude"),
           py::arg("height"))
      .def("reverse", &reverse, py::arg("enu"));
  Class<HeightField, std::shared_ptr<HeightField>>(module, "HeightField")
      .def(py::init(&height_field), py::arg("x"), py::arg("y"), py::arg("height"))
      .def("at", &height_at, py::arg("place"));
}

} // namespace firetwin::bindings
