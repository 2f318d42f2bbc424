#include "arrays.hpp"
#include "bindings.hpp"
#include "flow/detail.hpp"
#include "flow/drift.hpp"

#include <pybind11/stl.h>

#include <memory>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using flow::Detail;
using flow::Drift;
using flow::Index;

Array<float> drift_values(const Drift& drift) {
  const flow::Shape s = drift.shape();
  auto result = new_array<float>({s.nz, s.ny, s.nx, Drift::phases, 3});
  const auto values = drift.values();
  std::copy(values.begin(), values.end(), result.mutable_data());
  return result;
}

void drift_restore(Drift& drift, double time, const py::object& values) {
  const flow::Shape s = drift.shape();
  const auto array = to_array<float>(values, "values", {s.nz, s.ny, s.nx, Drift::phases, 3});
  drift.restore(time, view(array));
}

std::shared_ptr<Detail>
make_detail(double spacing, const std::array<double, 2>& corner, const py::object& levels,
            const py::object& heights, const py::object& ground, const py::object& smoke,
            const py::object& age, const py::object& rise, const py::object& temperature_excess,
            const py::object& drift, const std::array<float, Drift::phases>& weights,
            const std::array<std::int64_t, Drift::phases>& turns, const py::object& glow,
            double size, float scale, const std::array<double, 3>& blur, double opacity,
            float max_extinction, const std::array<float, 2>& ages, float condensation_height,
            std::uint32_t seed) {
  const auto amount = to_array<float>(smoke, "smoke", {-1, -1, -1});
  const std::vector<py::ssize_t> shape{amount.shape(0), amount.shape(1), amount.shape(2)};
  const auto field = [&](const py::object& object, const char* name) {
    return to_array<float>(object, name, shape);
  };
  const auto middles = to_array<double>(levels, "levels", {shape[0]});
  const auto high = field(heights, "heights"), old = field(age, "age"), up = field(rise, "rise"),
             warm = field(temperature_excess, "temperature_excess");
  const auto light = glow.is_none() ? Array<float>(py::ssize_t{0}) : field(glow, "glow");
  const auto low = to_array<float>(ground, "ground", {shape[1], shape[2]});
  const auto moved =
      to_array<float>(drift, "drift", {shape[0], shape[1], shape[2], Drift::phases, 3});
  const flow::SmokeSnapshot snapshot{{shape[0], shape[1], shape[2]},
                                     spacing,
                                     corner,
                                     view(middles),
                                     view(high),
                                     view(low),
                                     view(amount),
                                     view(old),
                                     view(up),
                                     view(warm),
                                     view(light),
                                     view(moved),
                                     weights,
                                     turns};
  const flow::DetailSettings settings{
      size, scale, blur, opacity, max_extinction, ages, condensation_height, seed};
  const py::gil_scoped_release release;
  return std::make_shared<Detail>(snapshot, settings);
}

std::shared_ptr<SparseSmoke> paint_sparse(const Detail& detail, const std::array<double, 3>& origin,
                                          double voxel, const py::object& surface,
                                          const py::object& share, Index layers,
                                          const py::object& wanted, float min_extinction,
                                          const py::object& log_gain,
                                          const std::array<float, 2>& lean, float gain_height) {
  const auto ground = to_array<float>(surface, "surface", {-1, -1});
  const auto part = to_array<float>(share, "share", {ground.shape(0), ground.shape(1)});
  flow::VoxelRegion brick{origin,       voxel,      {ground.shape(0), ground.shape(1), layers},
                          view(ground), view(part), {},
                          {},           lean,       gain_height};
  const auto blocks = brick.blocks();
  const auto asked = wanted.is_none() ? Array<std::uint8_t>(py::ssize_t{0})
                                      : to_array<std::uint8_t>(wanted, "wanted",
                                                               {blocks[0], blocks[1], blocks[2]});
  brick.wanted = view(asked);
  const auto placed = log_gain.is_none() ? Array<float>(py::ssize_t{0})
                                         : to_array<float>(log_gain, "log_gain",
                                                           {ground.shape(0), ground.shape(1)});
  brick.log_gain = view(placed);
  const py::gil_scoped_release release;
  return std::make_shared<SparseSmoke>(detail.paint(brick, min_extinction));
}

/// Paints dense voxels.
py::tuple paint(const Detail& detail, const std::array<double, 3>& origin, double voxel,
                const py::object& surface, const py::object& share, Index layers,
                const py::object& wanted) {
  const auto smoke = paint_sparse(detail, origin, voxel, surface, share, layers, wanted, 0.0F,
                                  py::none(), {}, 1.0F);
  const auto dense = [&](SparseSmoke::Field field) {
    const auto& shape = smoke->shape();
    auto array = zeros({shape[0], shape[1], shape[2]});
    smoke->spread(field, writable(array));
    return array;
  };
  return py::make_tuple(dense(SparseSmoke::density), dense(SparseSmoke::fresh),
                        detail.glows() ? py::object(dense(SparseSmoke::glow))
                                       : py::object(py::none()));
}

} // namespace

void init_flow_detail(Module module) {
  using namespace py::literals;
  Class<Drift, std::shared_ptr<Drift>>(module, "Drift")
      .def(py::init([](const std::shared_ptr<flow::Solver>& solver, double period) {
             return std::make_shared<Drift>(solver, period);
           }),
           "solver"_a, "period"_a = 120.0)
      .def("advance", &Drift::advance, py::call_guard<py::gil_scoped_release>())
      .def("values", &drift_values)
      .def("restore", &drift_restore, "time"_a, "values"_a)
      .def_property_readonly("time", &Drift::time)
      .def_property_readonly("weights", &Drift::weights)
      .def_property_readonly("turns", &Drift::turns);
  Class<Detail, std::shared_ptr<Detail>>(module, "Detail")
      .def(py::init(&make_detail), py::kw_only(), "spacing"_a, "corner"_a, "levels"_a, "heights"_a,
           "ground"_a, "smoke"_a, "age"_a, "rise"_a, "temperature_excess"_a, "drift"_a, "weights"_a,
           "turns"_a, "glow"_a = py::none(), "size"_a = 340.0, "scale"_a = 1.0F,
           "blur"_a = std::array<double, 3>{}, "opacity"_a = 1.0, "max_extinction"_a = 0.03F,
           "ages"_a = std::array<float, 2>{20.0F, 600.0F}, "condensation_height"_a = 1.0e6F,
           "seed"_a = 0)
      .def("paint", &paint, "origin"_a, "voxel"_a, "surface"_a, "share"_a, "layers"_a,
           "wanted"_a = py::none())
      .def("paint_sparse", &paint_sparse, "origin"_a, "voxel"_a, "surface"_a, "share"_a, "layers"_a,
           "wanted"_a = py::none(), "min_extinction"_a = 0.0F, "log_gain"_a = py::none(),
           "lean"_a = std::array<float, 2>{}, "gain_height"_a = 250.0F);
}

} // namespace firetwin::bindings
