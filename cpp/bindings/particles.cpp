#include "arrays.hpp"
#include "base/constants.hpp"
#include "bindings.hpp"
#include "broadcast.hpp"
#include "particles/advance.hpp"
#include "particles/particle_cloud.hpp"

#include <pybind11/stl.h>

#include <memory>
#include <optional>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using geo::HeightField;
using particles::ParticleCloud;
using particles::ParticleKind;

py::tuple advance(const py::object& position, const py::object& velocity, const py::object& wind,
                  double step, const py::object& relaxation, const py::object& lift,
                  const py::object& wind_end, const py::object& wind_middle,
                  const py::object& landed, const HeightField* ground) {
  auto p = to_array<double>(position, "position", {-1, 3});
  const py::ssize_t n = p.shape(0);
  p = spread<double>(p, "position", {n, 3}); // a copy
  auto v = spread<double>(velocity, "velocity", {n, 3});
  auto down = spread<std::uint8_t>(landed, "landed", {n});
  const auto w0 = spread<double>(wind, "wind", {n, 3});
  const auto w2 = wind_end.is_none() ? w0 : spread<double>(wind_end, "wind_end", {n, 3});
  const auto w1 = spread<double>(wind_middle.is_none() ? (w0 + w2) * py::float_(0.5) : wind_middle,
                                 "wind_middle", {n, 3});
  const auto a = spread<double>(lift, "lift", {n});
  const auto tau = spread<double>(relaxation, "relaxation", {n});
  const particles::Particles all{writable(p), writable(v), writable(down)};
  const particles::Forces forces{view(w0), view(w1), view(w2), view(a), view(tau)};
  {
    const py::gil_scoped_release release;
    particles::advance(all, forces, step, ground);
  }
  return py::make_tuple(p, v, down.attr("view")("bool"));
}

std::shared_ptr<ParticleCloud> state(double time, const py::object& position,
                                     const py::object& start, const py::object& end,
                                     const py::object& rate, const ParticleKind& kind,
                                     const py::object& wind, const py::object& wind_time,
                                     const py::object& id, double size, const HeightField* ground,
                                     std::uint64_t seed) {
  const auto places = to_array<double>(position, "position", {-1, 3});
  const py::ssize_t m = places.shape(0);
  const auto begins = spread<double>(start, "start", {m});
  const auto ends = spread<double>(end, "end", {m});
  const auto rates = spread<double>(rate, "rate", {m});
  const py::object numbers = id.is_none() ? py::module_::import("numpy").attr("arange")(m) : id;
  const auto ids = to_array<std::uint64_t>(numbers, "id", {m});
  const auto times = to_array<double>(wind_time, "wind_time", {-1});
  const auto any = to_array<double>(wind, "wind");
  const py::ssize_t k = times.size();
  const auto winds = any.ndim() == 3 ? spread<double>(any, "wind", {k, m, 3})
                                     : spread<double>(any, "wind", {k, 3});
  const particles::Sources sources{view(places), view(begins), view(ends),
                                   view(rates),  view(ids),    size};
  const py::gil_scoped_release release;
  return std::make_shared<ParticleCloud>(
      particles::state(time, sources, kind, {view(times), view(winds)}, ground, seed));
}

template <auto member> auto column(const py::object& self) {
  return lend_column(self.cast<const ParticleCloud&>().*member, self);
}

template <std::vector<double> ParticleCloud::* member>
Array<double> vectors(const py::object& self) {
  const auto& cloud = self.cast<const ParticleCloud&>();
  return lend<double>(cloud.*member, {length(cloud.source.size()), 3}, self);
}

} // namespace

void init_particles(Module module) {
  Class<ParticleKind>(module, "ParticleKind")
      .def(py::init<double, particles::Range, particles::Range, particles::Range,
                    particles::Range>(),
           py::arg("lift"), py::arg("relaxation"), py::arg("rise"), py::arg("spread"),
           py::arg("life"))
      .def_readonly("lift", &ParticleKind::lift)
      .def_readonly("relaxation", &ParticleKind::relaxation)
      .def_readonly("rise", &ParticleKind::rise)
      .def_readonly("spread", &ParticleKind::spread)
      .def_readonly("life", &ParticleKind::life);
  Class<ParticleCloud, std::shared_ptr<ParticleCloud>>(module, "ParticleCloud")
      .def_property_readonly("source", &column<&ParticleCloud::source>)
      .def_property_readonly("number", &column<&ParticleCloud::number>)
      .def_property_readonly("position", &vectors<&ParticleCloud::position>)
      .def_property_readonly("velocity", &vectors<&ParticleCloud::velocity>)
      .def_property_readonly("age", &column<&ParticleCloud::age>)
      .def_property_readonly("life", &column<&ParticleCloud::life>)
      .def_property_readonly("landed",
                             [](const py::object& self) {
                               return column<&ParticleCloud::landed>(self).attr("view")("bool");
                             })
      .def("__len__", [](const ParticleCloud& cloud) { return cloud.source.size(); });
  module.def("lift", &particles::lift, py::arg("density"),
             py::arg("air_density") = constants::air_density);
  module.def("advance", &advance, py::arg("position"), py::arg("velocity"), py::arg("wind"),
             py::arg("step"), py::arg("relaxation"), py::arg("lift") = -constants::gravity,
             py::arg("wind_end") = py::none(), py::arg("wind_middle") = py::none(),
             py::arg("landed") = false, py::arg("ground") = py::none());
  module.def("state", &state, py::arg("time"), py::arg("position"), py::arg("start"),
             py::arg("end"), py::arg("rate"), py::arg("kind"), py::arg("wind"),
             py::arg("wind_time") = std::vector<double>{0.0}, py::arg("id") = py::none(),
             py::arg("size") = 0.0, py::arg("ground") = py::none(), py::arg("seed") = 0);
}

} // namespace firetwin::bindings
