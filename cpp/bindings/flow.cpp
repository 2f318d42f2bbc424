#include "arrays.hpp"
#include "bindings.hpp"
#include "flow/solver.hpp"
#include "flow/views.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <initializer_list>
#include <memory>
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

flow::Box box(const py::object& levels, const std::array<Index, 2>& shape, double spacing,
              const std::array<double, 2>& corner, const py::object& ground) {
  flow::Box result{shape[1], shape[0], spacing, numbers(levels, "levels"), corner, {}};
  if (!ground.is_none()) {
    const auto heights = to_array<double>(ground, "ground", {shape[0], shape[1]});
    result.ground.assign(heights.data(), heights.data() + heights.size());
  }
  return result;
}

flow::Settings settings(double side_width, double side_time, double top, double top_time,
                        double ground_time, double mixing, double source_depth,
                        double gust_strength, double gust_size, double gust_time,
                        std::uint64_t seed) {
  return {{side_width, side_time, top, top_time, ground_time},
          {gust_strength, gust_size, gust_time, seed},
          mixing,
          source_depth};
}

std::shared_ptr<Solver>
make(const py::object& levels, const std::array<Index, 2>& shape, double spacing,
     const py::object& height, const py::object& potential_temperature, const py::object& wind,
     const py::object& water, double pressure, const std::array<double, 2>& corner,
     const py::object& ground, double side_width, double side_time, double top, double top_time,
     double ground_time, double mixing, double source_depth, double gust_strength, double gust_size,
     double gust_time, std::uint64_t seed) {
  auto where = box(levels, shape, spacing, corner, ground);
  flow::Profile profile{
      numbers(height, "height"), numbers(potential_temperature, "potential_temperature"),
      pairs(wind, "wind"), water.is_none() ? std::vector<double>() : numbers(water, "water"),
      pressure};
  const auto how = settings(side_width, side_time, top, top_time, ground_time, mixing, source_depth,
                            gust_strength, gust_size, gust_time, seed);
  const py::gil_scoped_release release;
  return std::make_shared<Solver>(std::move(where), std::move(profile), how);
}

std::shared_ptr<Solver> nest(const std::shared_ptr<Solver>& outer, const py::object& levels,
                             const std::array<Index, 2>& shape, double spacing,
                             const std::array<double, 2>& corner, const py::object& ground,
                             double side_width, double side_time, double top, double top_time,
                             double ground_time, double mixing, double source_depth,
                             double gust_strength, double gust_size, double gust_time,
                             std::uint64_t seed) {
  auto where = box(levels, shape, spacing, corner, ground);
  const auto how = settings(side_width, side_time, top, top_time, ground_time, mixing, source_depth,
                            gust_strength, gust_size, gust_time, seed);
  const py::gil_scoped_release release;
  return std::make_shared<Solver>(std::move(where), outer, how);
}

void set_sources(Solver& solver, const py::object& position, const py::object& heat,
                 const py::object& smoke, const py::object& water) {
  flow::Sources sources{pairs(position, "position"), numbers(heat, "heat"), numbers(smoke, "smoke"),
                        water.is_none() ? std::vector<double>() : numbers(water, "water")};
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
  const flow::Mass m = solver.mass();
  return named({{"initial", m.initial},
                {"emitted", m.emitted},
                {"entered", m.entered},
                {"left", m.left},
                {"airborne", m.airborne},
                {"rounding", m.rounding}});
}

py::dict heat(const Solver& solver) {
  const flow::Heat h = solver.heat();
  return named({{"given", h.given}, {"warmed", h.warmed}, {"held", h.held}});
}

/// The fields that a state is made of: f(name, field, levels, rows, columns).
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
  parts(solver, solver.open(),
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
  const Solver::Account a = solver.account();
  const std::vector<double> account{a.time,          static_cast<double>(a.steps),
                                    a.mass.initial,  a.mass.emitted,
                                    a.mass.entered,  a.mass.left,
                                    a.mass.rounding, a.heat.given,
                                    a.heat.warmed};
  result["account"] = give(std::vector<double>(account), {length(account.size())});
  const auto& wind = solver.profile().wind;
  auto winds = new_array<double>({length(wind.size()), 2});
  std::copy_n(wind.front().data(), winds.size(), winds.mutable_data());
  result["wind"] = winds;
  return result;
}

void restore(Solver& solver, const py::dict& state) {
  const auto get = [&](const char* name) -> py::object {
    if (!state.contains(name)) {
      throw py::value_error("the state lacks " + std::string(name));
    }
    return state[name];
  };
  const auto account = to_array<double>(get("account"), "account", {9});
  const auto wind = pairs(get("wind"), "wind");
  std::vector<std::pair<flow::Field*, Array<float>>> all;
  parts(solver, solver.open(),
        [&](const char* name, flow::Field& field, Index levels, Index rows, Index columns) {
          all.emplace_back(&field, to_array<float>(get(name), name, {levels, rows, columns}));
        });
  const double* a = account.data();
  solver.resume({a[0],
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
  solver.close();
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

} // namespace

void init_flow(Module module) {
  using namespace py::literals;
  Class<Solver, std::shared_ptr<Solver>>(module, "Solver")
      .def(py::init(&make), "levels"_a, "shape"_a, "spacing"_a, "height"_a,
           "potential_temperature"_a, "wind"_a, py::kw_only(), "water"_a = py::none(),
           "pressure"_a = 101325.0, "corner"_a = std::array<double, 2>{}, "ground"_a = py::none(),
           "side_width"_a = 8.0, "side_time"_a = 40.0, "top"_a = 0.22, "top_time"_a = 60.0,
           "ground_time"_a = 300.0, "mixing"_a = 0.18, "source_depth"_a = 90.0,
           "gust_strength"_a = 0.0, "gust_size"_a = 400.0, "gust_time"_a = 90.0, "seed"_a = 0)
      .def("nest", &nest, "levels"_a, "shape"_a, "spacing"_a, "corner"_a, py::kw_only(),
           "ground"_a = py::none(), "side_width"_a = 10.0, "side_time"_a = 8.0, "top"_a = 0.22,
           "top_time"_a = 60.0, "ground_time"_a = 300.0, "mixing"_a = 0.18, "source_depth"_a = 90.0,
           "gust_strength"_a = 0.0, "gust_size"_a = 400.0, "gust_time"_a = 90.0, "seed"_a = 0)
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
      .def("warmth", &field<flow::warmth>)
      .def("cloud", &field<flow::cloud>)
      .def("heights", &field<flow::heights>)
      .def("mass", &mass)
      .def("heat", &heat)
      .def("state", &state)
      .def("restore", &restore, "state"_a);
}

} // namespace firetwin::bindings
