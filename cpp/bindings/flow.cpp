#include "arrays.hpp"
#include "bindings.hpp"
#include "flow/diagnostics.hpp"
#include "flow/solver.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <optional>
#include <utility>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using flow::Index;
using flow::Solver;

std::vector<double> numbers(const py::object& object, const std::string& name) {
  const auto array = to_array<double>(object, name, {-1});
  return {array.data(), array.data() + array.size()};
}

std::vector<std::array<double, 2>> pairs(const py::object& object, const std::string& name) {
  const auto array = to_array<double>(object, name, {-1, 2});
  std::vector<std::array<double, 2>> result(static_cast<std::size_t>(array.shape(0)));
  std::copy_n(array.data(), array.size(), result.empty() ? nullptr : result.front().data());
  return result;
}

std::vector<double> optional_numbers(const py::object& object, const std::string& name) {
  return object.is_none() ? std::vector<double>() : numbers(object, name);
}

flow::Domain domain(const py::object& levels, const std::array<Index, 2>& shape, double spacing,
                    const std::array<double, 2>& corner, const py::object& ground) {
  flow::Domain result{shape[1], shape[0], spacing, numbers(levels, "levels"), corner, {}};
  if (!ground.is_none()) {
    const auto heights = to_array<double>(ground, "ground", {shape[0], shape[1]});
    result.ground.assign(heights.data(), heights.data() + heights.size());
  }
  return result;
}

flow::Profile profile(const py::object& height, const py::object& potential_temperature,
                      const py::object& wind, const py::object& water, double pressure) {
  return {numbers(height, "height"), numbers(potential_temperature, "potential_temperature"),
          pairs(wind, "wind"), optional_numbers(water, "water"), pressure};
}

flow::SolverSettings settings(double sponge_width, double sponge_time, double damping_share,
                              double damping_time, double drag_time, double smagorinsky,
                              double source_depth, double gust_strength, double gust_size,
                              double gust_time, std::uint64_t seed) {
  return {{sponge_width, sponge_time, damping_share, damping_time, drag_time},
          {gust_strength, gust_size, gust_time, seed},
          smagorinsky,
          source_depth};
}

using OptionalSettings = std::optional<flow::SolverSettings>;

std::shared_ptr<Solver> make(const flow::Domain& domain, const flow::Profile& profile,
                             const OptionalSettings& settings) {
  const py::gil_scoped_release release;
  return std::make_shared<Solver>(domain, profile, settings.value_or(flow::SolverSettings{}));
}

std::shared_ptr<Solver> nest(const std::shared_ptr<Solver>& outer, const flow::Domain& domain,
                             const OptionalSettings& settings) {
  const py::gil_scoped_release release;
  return std::make_shared<Solver>(domain, outer, settings.value_or(flow::nest_settings()));
}

void set_sources(Solver& solver, const py::object& position, const py::object& heat,
                 const py::object& smoke, const py::object& water) {
  flow::Sources sources{pairs(position, "position"), numbers(heat, "heat"), numbers(smoke, "smoke"),
                        optional_numbers(water, "water")};
  solver.set_sources(std::move(sources));
}

void step(Solver& solver, double dt, int count) {
  const py::gil_scoped_release release;
  for (int i = 0; i < count; ++i) {
    solver.step(dt);
  }
}

template <void view(const Solver&, std::span<float>)> Array<float> field(const Solver& solver) {
  const flow::Lattice& l = solver.lattice();
  auto result = new_array<float>({l.nz, l.ny, l.nx});
  const auto out = writable(result);
  const py::gil_scoped_release release;
  view(solver, out);
  return result;
}

Array<float> velocity(const Solver& solver) {
  const flow::Lattice& l = solver.lattice();
  auto result = new_array<float>({l.nz, l.ny, l.nx, 3});
  const auto out = writable(result);
  const py::gil_scoped_release release;
  flow::velocity(solver, out);
  return result;
}

py::dict named(std::initializer_list<std::pair<const char*, double>> numbers) {
  py::dict result;
  for (const auto& [name, number] : numbers) {
    result[name] = number;
  }
  return result;
}

py::dict mass(const Solver& solver) {
  const flow::MassBudget m = solver.mass();
  return named({{"initial", m.initial},
                {"emitted", m.emitted},
                {"entered", m.entered},
                {"left", m.left},
                {"airborne", m.airborne},
                {"rounding", m.rounding}});
}

py::dict heat(const Solver& solver) {
  const flow::HeatBudget h = solver.heat();
  return named({{"given", h.given}, {"warmed", h.warmed}, {"held", h.held}});
}

/// Calls f(name, field, levels, rows, columns) for each field of a state.
template <class Function> void parts(const Solver& solver, flow::State& s, const Function& f) {
  const flow::Lattice& l = solver.lattice();
  f("u", s.wind.u, l.nz, l.ny, l.nx + 1);
  f("v", s.wind.v, l.nz, l.ny + 1, l.nx);
  f("w", s.wind.w, l.nz + 1, l.ny, l.nx);
  f("theta", s.theta, l.nz, l.ny, l.nx);
  f("smoke", s.smoke, l.nz, l.ny, l.nx);
  f("age", s.age, l.nz, l.ny, l.nx);
  if (solver.ambient().moist()) {
    f("water", s.water, l.nz, l.ny, l.nx);
  }
}

py::dict state(Solver& solver) {
  py::dict result;
  parts(solver, solver.mutable_state(),
        [&](const char* name, flow::Field& field, Index levels, Index rows, Index columns) {
          auto array = new_array<float>({levels, rows, columns});
          float* to = array.mutable_data();
          for (Index k = 0; k < levels; ++k) {
            for (Index j = 0; j < rows; ++j, to += columns) {
              std::copy_n(field.row(k, j), columns, to);
            }
          }
          result[name] = array;
        });
  const Solver::Checkpoint a = solver.checkpoint();
  const std::vector<double> checkpoint{a.time,          static_cast<double>(a.steps),
                                       a.mass.initial,  a.mass.emitted,
                                       a.mass.entered,  a.mass.left,
                                       a.mass.rounding, a.heat.given,
                                       a.heat.warmed};
  result["account"] = give(std::vector<double>(checkpoint), {length(checkpoint.size())});
  const auto& wind = solver.profile().wind;
  auto winds = new_array<double>({length(wind.size()), 2});
  std::copy_n(wind.front().data(), winds.size(), winds.mutable_data());
  result["wind"] = winds;
  return result;
}

void restore(Solver& solver, const py::dict& state) {
  const auto get = [&](const char* name) -> py::object {
    if (!state.contains(name)) {
      throw py::value_error("the state has no field " + std::string(name));
    }
    return state[name];
  };
  const auto checkpoint = to_array<double>(get("account"), "account", {9});
  const auto wind = pairs(get("wind"), "wind");
  std::vector<std::pair<flow::Field*, Array<float>>> all;
  parts(solver, solver.mutable_state(),
        [&](const char* name, flow::Field& field, Index levels, Index rows, Index columns) {
          all.emplace_back(&field, to_array<float>(get(name), name, {levels, rows, columns}));
        });
  const double* a = checkpoint.data();
  solver.restore({a[0],
                  static_cast<std::int64_t>(a[1]),
                  {a[2], a[3], a[4], a[5], 0.0, a[6]},
                  {a[7], a[8], 0.0}},
                 wind);
  for (auto& [field, array] : all) {
    const float* from = array.data();
    for (Index k = 0; k < array.shape(0); ++k) {
      for (Index j = 0; j < array.shape(1); ++j, from += array.shape(2)) {
        std::copy_n(from, array.shape(2), field->row(k, j));
      }
    }
  }
  solver.fill_ghost_cells();
}

Array<double> densities(const Solver& solver) {
  std::vector<double> result;
  for (Index k = 0; k < solver.lattice().nz; ++k) {
    result.push_back(solver.ambient().density(k));
  }
  return give(std::move(result), {solver.lattice().nz});
}

Array<double> levels(const Solver& solver) {
  return give(std::vector<double>(solver.lattice().face), {solver.lattice().nz + 1});
}

void bind_settings(const Module& module) {
  using namespace py::literals;
  using flow::SolverSettings;
  const SolverSettings defaults;
  Class<SolverSettings>(module, "SolverSettings")
      .def(py::init(&settings), py::kw_only(), "sponge_width"_a = defaults.relaxation.width,
           "sponge_time"_a = defaults.relaxation.time,
           "damping_share"_a = defaults.relaxation.damping_share,
           "damping_time"_a = defaults.relaxation.damping_time,
           "drag_time"_a = defaults.relaxation.drag_time, "smagorinsky"_a = defaults.smagorinsky,
           "source_depth"_a = defaults.source_depth, "gust_strength"_a = defaults.gusts.strength,
           "gust_size"_a = defaults.gusts.size, "gust_time"_a = defaults.gusts.time,
           "seed"_a = defaults.gusts.seed)
      .def_property_readonly("sponge_width",
                             [](const SolverSettings& s) { return s.relaxation.width; })
      .def_property_readonly("sponge_time",
                             [](const SolverSettings& s) { return s.relaxation.time; })
      .def_property_readonly("damping_share",
                             [](const SolverSettings& s) { return s.relaxation.damping_share; })
      .def_property_readonly("damping_time",
                             [](const SolverSettings& s) { return s.relaxation.damping_time; })
      .def_property_readonly("drag_time",
                             [](const SolverSettings& s) { return s.relaxation.drag_time; })
      .def_property_readonly("smagorinsky", [](const SolverSettings& s) { return s.smagorinsky; })
      .def_property_readonly("source_depth", [](const SolverSettings& s) { return s.source_depth; })
      .def_property_readonly("gust_strength",
                             [](const SolverSettings& s) { return s.gusts.strength; })
      .def_property_readonly("gust_size", [](const SolverSettings& s) { return s.gusts.size; })
      .def_property_readonly("gust_time", [](const SolverSettings& s) { return s.gusts.time; })
      .def_property_readonly("seed", [](const SolverSettings& s) { return s.gusts.seed; });
}

/// Binds the domain and the ambient profile.
void bind_domain(const Module& module) {
  using namespace py::literals;
  Class<flow::Domain>(module, "Domain")
      .def(py::init(&domain), "levels"_a, "shape"_a, "spacing"_a,
           "corner"_a = std::array<double, 2>{}, "ground"_a = py::none());
  Class<flow::Profile>(module, "Profile")
      .def(py::init(&profile), "height"_a, "potential_temperature"_a, "wind"_a,
           "water"_a = py::none(), "pressure"_a = flow::Profile{}.pressure);
}

} // namespace

void init_flow(Module module) {
  using namespace py::literals;
  bind_settings(module);
  bind_domain(module);
  Class<Solver, std::shared_ptr<Solver>>(module, "Solver")
      .def(py::init(&make), "domain"_a, "profile"_a, "settings"_a = py::none())
      .def("nest", &nest, "domain"_a, "settings"_a = py::none())
      .def("set_sources", &set_sources, "position"_a, "heat"_a, "smoke"_a, "water"_a = py::none())
      .def(
          "set_wind",
          [](Solver& solver, const py::object& wind) { solver.set_wind(pairs(wind, "wind")); },
          "wind"_a)
      .def("step", &step, "dt"_a, "count"_a = 1)
      .def_property_readonly("time", &Solver::time)
      .def_property_readonly("steps", &Solver::steps)
      .def_property_readonly("substeps", &Solver::substeps)
      .def_property_readonly("courant", &Solver::courant)
      .def_property_readonly("divergence", &Solver::divergence)
      .def_property_readonly("levels", &levels)
      .def_property_readonly("density", &densities)
      .def_property_readonly("spacing", [](const Solver& s) { return s.lattice().spacing; })
      .def_property_readonly(
          "corner", [](const Solver& s) { return py::make_tuple(s.corner()[0], s.corner()[1]); })
      .def_property_readonly("shape",
                             [](const Solver& s) {
                               const flow::Lattice& l = s.lattice();
                               return py::make_tuple(l.nz, l.ny, l.nx);
                             })
      .def("smoke", &field<flow::smoke_density>)
      .def("age", &field<flow::smoke_age>)
      .def("velocity", &velocity)
      .def("temperature_excess", &field<flow::temperature_excess>)
      .def("cloud", &field<flow::cloud>)
      .def("heights", &field<flow::heights>)
      .def("mass", &mass)
      .def("heat", &heat)
      .def("state", &state)
      .def("restore", &restore, "state"_a);
}

} // namespace firetwin::bindings
