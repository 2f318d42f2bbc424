#include "flames/flames.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "volume/flame_bake.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <tuple>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using flames::FlameLight;
using flames::FlameShape;
using flames::FlameSquare;
using flames::FlameView;
using flames::FlameVolume;
using flames::Spindle;

using SquareArrays = std::tuple<py::object, py::object, std::array<double, 2>, double>;

std::shared_ptr<FlameVolume> make_flames(const std::vector<SquareArrays>& squares,
                                         const py::object& spindles, const FlameShape& shape,
                                         const FlameLight& light, double pixel,
                                         const std::array<float, 2>& fade, const Vector& origin,
                                         double time) {
  std::vector<Array<float>> kept;
  std::vector<FlameSquare> given;
  kept.reserve(2 * squares.size());
  for (const auto& [length, ground, corner, spacing] : squares) {
    const auto& lengths = kept.emplace_back(to_array<float>(length, "length", {-1, -1}));
    const std::vector<py::ssize_t> wanted{lengths.shape(0), lengths.shape(1)};
    const auto& heights = kept.emplace_back(to_array<float>(ground, "ground", wanted));
    given.push_back({view(lengths), view(heights), {wanted[0], wanted[1]}, corner, spacing});
  }
  const auto rows = to_array<float>(spindles, "spindles", {-1, 6});
  std::vector<Spindle> crowns;
  for (py::ssize_t n = 0; n < rows.shape(0); ++n) {
    crowns.push_back(
        {rows.at(n, 0), rows.at(n, 1), rows.at(n, 2), rows.at(n, 3), rows.at(n, 4), rows.at(n, 5)});
  }
  const FlameView seen{static_cast<float>(pixel), fade};
  const py::gil_scoped_release release;
  return std::make_shared<FlameVolume>(given, crowns, shape, light, seen, origin, time);
}

Array<float> sample(const FlameVolume& flames, const py::object& points, double fine) {
  const auto places = to_array<double>(points, "points", {-1, 3});
  auto found = zeros({places.shape(0), static_cast<py::ssize_t>(volume::flame_values)});
  const std::span<float> out = writable(found);
  const py::gil_scoped_release release;
  volume::sample_flames(flames, view(places), static_cast<float>(fine), out);
  return found;
}

volume::VdbSummary write(const std::filesystem::path& path, const FlameVolume& flames,
                         double voxel_size, const std::optional<io::Metadata>& metadata) {
  const py::gil_scoped_release release;
  return volume::write_flames(path, flames, voxel_size, metadata.value_or(io::Metadata{}));
}

} // namespace

void init_flames(Module module) {
  using namespace py::literals;
  const FlameShape defaults;
  Class<FlameShape>(module, "FlameShape")
      .def(py::init([](const std::array<double, 2>& wind, float fill, float taper, float ragged,
                       float edge, float roll, float broken) {
             FlameShape made{};
             made.wind = wind;
             made.fill = fill;
             made.taper = taper;
             made.ragged = ragged;
             made.edge = edge;
             made.roll = roll;
             made.broken = broken;
             return made;
           }),
           py::kw_only(), "wind"_a, "fill"_a = defaults.fill, "taper"_a = defaults.taper,
           "ragged"_a = defaults.ragged, "edge"_a = defaults.edge, "roll"_a = defaults.roll,
           "broken"_a = defaults.broken);
  Class<FlameLight>(module, "FlameLight")
      .def(py::init([](const std::vector<std::array<float, 3>>& visible, float extinction,
                       float soot, const std::array<float, 3>& soot_light, double coolest,
                       double hottest, const std::vector<std::array<float, 3>>& scales,
                       float infrared, float dim) {
             return FlameLight{visible, extinction, soot,     soot_light, coolest,
                               hottest, scales,     infrared, dim};
           }),
           py::kw_only(), "visible"_a, "extinction"_a, "soot"_a, "soot_light"_a, "coolest"_a,
           "hottest"_a, "scales"_a, "infrared"_a, "dim"_a);
  Class<FlameVolume, std::shared_ptr<FlameVolume>>(module, "FlameVolume")
      .def(py::init(&make_flames), py::kw_only(), "squares"_a, "spindles"_a, "shape"_a, "light"_a,
           "pixel"_a, "fade"_a, "origin"_a, "time"_a)
      .def("sample", &sample, "points"_a, "fine"_a = 0.0);
  module.def("write_flames", &write, "path"_a, "flames"_a, "voxel_size"_a, py::kw_only(),
             "metadata"_a = py::none());
}

} // namespace firetwin::bindings
