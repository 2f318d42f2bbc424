#include "arrays.hpp"
#include "bindings.hpp"
#include "flux/arrival.hpp"
#include "flux/at_time.hpp"
#include "flux/emitters.hpp"

#include <memory>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using flux::Emitters;

std::shared_ptr<Emitters> emitters(const py::object& flux_object, const py::object& position,
                                   double flux_min, double flux_max) {
  const auto flux = to_array<float>(flux_object, "flux", {-1, -1});
  const auto points = to_array<double>(position, "position", {flux.shape(0), flux.shape(1), 3});
  const py::gil_scoped_release release;
  return std::make_shared<Emitters>(flux::emitters(view(flux), view(points), flux_min, flux_max));
}

Array<float> at_time(const run::Run& run, double time) {
  std::vector<float> flux;
  {
    const py::gil_scoped_release release;
    flux = flux::at_time(run, time);
  }
  return give(std::move(flux), {length(run.latitude().size()), length(run.longitude().size())});
}

Array<float> arrival_time(const run::Run& run, bool averaged) {
  std::vector<float> times;
  {
    const py::gil_scoped_release release;
    times = flux::arrival_time(run, averaged);
  }
  return give(std::move(times), {length(run.latitude().size()), length(run.longitude().size())});
}

template <auto member> auto column(const py::object& self) {
  return lend_column(self.cast<const Emitters&>().*member, self);
}

} // namespace

void init_flux(Module module) {
  Class<Emitters, std::shared_ptr<Emitters>>(module, "Emitters")
      .def_property_readonly("cell", &column<&Emitters::cell>)
      .def_property_readonly("position",
                             [](const py::object& self) {
                               const auto& e = self.cast<const Emitters&>();
                               return lend<double>(e.position, {length(e.cell.size()), 3}, self);
                             })
      .def_property_readonly("intensity", &column<&Emitters::intensity>)
      .def_property_readonly("scale", &column<&Emitters::scale>)
      .def_property_readonly("colour", &column<&Emitters::colour>)
      .def_property_readonly("flux", &column<&Emitters::flux>)
      .def_readonly("invalid", &Emitters::invalid)
      .def("__len__", [](const Emitters& e) { return e.cell.size(); });
  module.def("emitters", &emitters, py::arg("flux"), py::arg("position"), py::arg("flux_min"),
             py::arg("flux_max"));
  module.def("at_time", &at_time, py::arg("run"), py::arg("time"));
  module.def("arrival_time", &arrival_time, py::arg("run"), py::arg("averaged") = true);
}

} // namespace firetwin::bindings
