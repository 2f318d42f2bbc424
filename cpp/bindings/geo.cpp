#include "arrays.hpp"
#include "bindings.hpp"
#include "broadcast.hpp"
#include "geo/height_field.hpp"
#include "geo/local_frame.hpp"

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/MGRS.hpp>
#include <GeographicLib/TransverseMercator.hpp>
#include <GeographicLib/UTMUPS.hpp>

#include <memory>
#include <tuple>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using geo::HeightField;
using geo::LocalFrame;
using GeographicLib::Geodesic;
using GeographicLib::TransverseMercator;
using GeographicLib::UTMUPS;

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

py::tuple geodesic_inverse(const py::object& latitude, const py::object& longitude,
                           const py::object& to_latitude, const py::object& to_longitude) {
  return map_arrays<3>(std::array{Named{latitude, "latitude"}, Named{longitude, "longitude"},
                                  Named{to_latitude, "to_latitude"},
                                  Named{to_longitude, "to_longitude"}},
                       [](const auto& at) {
                         double length = 0.0, first = 0.0, last = 0.0;
                         Geodesic::WGS84().Inverse(at[0], at[1], at[2], at[3], length, first, last);
                         return length == 0.0 ? std::array{0.0, 0.0, 0.0} // not 180 in the north
                                              : std::array{length, first, last};
                       });
}

py::tuple geodesic_direct(const py::object& latitude, const py::object& longitude,
                          const py::object& azimuth, const py::object& length) {
  return map_arrays<3>(std::array{Named{latitude, "latitude"}, Named{longitude, "longitude"},
                                  Named{azimuth, "azimuth"}, Named{length, "length"}},
                       [](const auto& from) {
                         std::array<double, 3> to{};
                         Geodesic::WGS84().Direct(from[0], from[1], from[2], from[3], to[0], to[1],
                                                  to[2]);
                         return to;
                       });
}

/// A UTM zone. Not by UTMUPS::Forward and Reverse, which reject points far from the zone.
struct Utm {
  int zone;
  bool south;
  double meridian() const { return 6.0 * zone - 183.0; }
  double false_north() const { return south ? 10'000'000.0 : 0.0; }
};
constexpr double false_east = 500'000.0;

py::tuple utm_forward(const Utm& utm, const py::object& latitude, const py::object& longitude) {
  return map_arrays<3>(std::array{Named{latitude, "latitude"}, Named{longitude, "longitude"}},
                       [&utm](const auto& place) {
                         double east = 0.0, north = 0.0, convergence = 0.0, scale = 0.0;
                         TransverseMercator::UTM().Forward(utm.meridian(), place[0], place[1], east,
                                                           north, convergence, scale);
                         return std::array{east + false_east, north + utm.false_north(),
                                           convergence};
                       });
}

py::tuple utm_reverse(const Utm& utm, const py::object& east, const py::object& north) {
  return map_arrays<2>(std::array{Named{east, "east"}, Named{north, "north"}},
                       [&utm](const auto& at) {
                         double latitude = 0.0, away = 0.0;
                         TransverseMercator::UTM().Reverse(
                             0.0, at[0] - false_east, at[1] - utm.false_north(), latitude, away);
                         return std::array{latitude, utm.meridian() + away};
                       });
}

std::string utm_square(const Utm& utm, double east, double north) {
  try {
    std::string name;
    GeographicLib::MGRS::Forward(utm.zone, !utm.south, east, north, 0, name);
    return name;
  } catch (const GeographicLib::GeographicErr&) {
    return {};
  }
}

int utm_zone(double latitude, double longitude) {
  return UTMUPS::StandardZone(latitude, longitude, UTMUPS::UTM);
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
  Class<Utm>(module, "Utm")
      .def(py::init<int, bool>(), py::arg("zone"), py::arg("south"))
      .def("forward", &utm_forward, py::arg("latitude"), py::arg("longitude"))
      .def("reverse", &utm_reverse, py::arg("east"), py::arg("north"))
      .def("square", &utm_square, py::arg("east"), py::arg("north"));
  module.def("utm_zone", &utm_zone, py::arg("latitude"), py::arg("longitude"));
  module.def("geodesic_inverse", &geodesic_inverse, py::arg("latitude"), py::arg("longitude"),
             py::arg("to_latitude"), py::arg("to_longitude"));
  module.def("geodesic_direct", &geodesic_direct, py::arg("latitude"), py::arg("longitude"),
             py::arg("azimuth"), py::arg("length"));
}

} // namespace firetwin::bindings
