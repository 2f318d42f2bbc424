#include "arrays.hpp"
#include "bindings.hpp"
#include "flux/emitters.hpp"
#include "flux/interpolator.hpp"

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

using flux::Interpolator;

std::unique_ptr<Interpolator> interpolator(std::shared_ptr<const run::Run> run) {
  const py::gil_scoped_release release;
  return std::make_unique<Interpolator>(std::move(run));
}

flux::SparseFlux frame(const Interpolator& model, double time) {
  const py::gil_scoped_release release;
  return model.at(time);
}

/// Heat flux of all cells. NumPy's zeros are lazily allocated pages.
Array<float> at(const Interpolator& model, double time) {
  const flux::SparseFlux found = frame(model, time);
  const py::tuple shape =
      py::make_tuple(model.run().latitude().size(), model.run().longitude().size());
  Array<float> all = py::module_::import("numpy").attr("zeros")(shape, "f4");
  const auto out = writable(all);
  for (std::size_t i = 0; i < found.cell.size(); ++i) {
    out[static_cast<std::size_t>(found.cell[i])] = found.flux[i];
  }
  return all;
}

py::tuple burning(const Interpolator& model, double time) {
  flux::SparseFlux found = frame(model, time);
  const py::ssize_t count = length(found.cell.size());
  return py::make_tuple(give(std::move(found.cell), {count}), give(std::move(found.flux), {count}));
}

Array<float> at_time(std::shared_ptr<const run::Run> run, double time) {
  return at(*interpolator(std::move(run)), time);
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
  Class<Interpolator>(module, "Interpolator")
      .def(py::init(&interpolator), py::arg("run"))
      .def("at", &at, py::arg("time"))
      .def("burning", &burning, py::arg("time"));
  module.def("at_time", &at_time, py::arg("run"), py::arg("time"));
}

} // namespace firetwin::bindings
