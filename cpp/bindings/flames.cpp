#include "flames/flames.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "flames/soot.hpp"
#include "volume/flame_bake.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <tuple>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using flames::BlockScale;
using flames::FlameBlock;
using flames::FlameLibrary;
using flames::FlameLight;
using flames::FlamePatches;
using flames::FlameShape;
using flames::FlameView;
using flames::FlameVolume;
using flames::Spindle;

constexpr py::ssize_t patch_nodes = flames::patch_side + 1;

std::shared_ptr<FlameBlock> make_block(const py::object& codes, const py::object& rise, double cell,
                                       double front, double interval, int fade, double wind,
                                       bool periodic, bool soft) {
  const auto stored = to_array<std::uint8_t>(codes, "codes", {-1, -1, -1, -1});
  const auto speeds = to_array<float>(rise, "rise", {stored.shape(1)});
  const FlameBlock::Shape shape{stored.shape(0), stored.shape(1), stored.shape(2), stored.shape(3)};
  const BlockScale scale{static_cast<float>(cell),
                         static_cast<float>(front),
                         static_cast<float>(interval),
                         fade,
                         static_cast<float>(wind),
                         periodic,
                         soft};
  return std::make_shared<FlameBlock>(view(stored), shape, scale, view(speeds));
}

std::shared_ptr<FlameLibrary>
make_library(const std::vector<std::vector<std::shared_ptr<FlameBlock>>>& lines,
             const std::vector<std::shared_ptr<FlameBlock>>& crowns) {
  std::vector<FlameLibrary::Kind> kinds;
  for (const auto& kind : lines) {
    kinds.emplace_back(kind.begin(), kind.end());
  }
  return std::make_shared<FlameLibrary>(std::move(kinds),
                                        FlameLibrary::Kind(crowns.begin(), crowns.end()));
}

std::shared_ptr<FlameVolume>
make_flames(const std::tuple<py::object, py::object, py::object>& patches,
            const py::object& spindles, const std::shared_ptr<FlameLibrary>& library,
            const FlameShape& shape, const FlameLight& light, double pixel,
            const std::array<float, 2>& fade, const Vector& origin, double time) {
  const auto spacings = to_array<double>(std::get<2>(patches), "spacings", {-1});
  const py::ssize_t count = spacings.shape(0);
  const auto corners = to_array<double>(std::get<1>(patches), "corners", {count, 2});
  const auto nodes = to_array<float>(
      std::get<0>(patches), "nodes",
      {count, patch_nodes, patch_nodes, static_cast<py::ssize_t>(flames::channel_count)});
  const auto rows = to_array<float>(spindles, "spindles", {-1, 6});
  std::vector<Spindle> crowns;
  for (py::ssize_t n = 0; n < rows.shape(0); ++n) {
    crowns.push_back(
        {rows.at(n, 0), rows.at(n, 1), rows.at(n, 2), rows.at(n, 3), rows.at(n, 4), rows.at(n, 5)});
  }
  const FlamePatches given{view(nodes), view(corners), view(spacings)};
  const FlameView seen{static_cast<float>(pixel), fade};
  const py::gil_scoped_release release;
  return std::make_shared<FlameVolume>(given, crowns, library, shape, light, seen, origin, time);
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
  module.attr("CORE_HEAT") = flames::core_heat;
  module.attr("LUMINANCE_DECADES") = py::make_tuple(flames::dim_decades, flames::bright_decades);
  Class<FlameBlock, std::shared_ptr<FlameBlock>>(module, "FlameBlock")
      .def(py::init(&make_block), "codes"_a, "rise"_a, py::kw_only(), "cell"_a, "front"_a,
           "interval"_a, "fade"_a, "wind"_a, "periodic"_a, "soft"_a = false);
  Class<FlameLibrary, std::shared_ptr<FlameLibrary>>(module, "FlameLibrary")
      .def(py::init(&make_library), "lines"_a, "crowns"_a);
  Class<FlameShape>(module, "FlameShape")
      .def(py::init([](const std::array<double, 2>& wind) { return FlameShape{.wind = wind}; }),
           py::kw_only(), "wind"_a);
  Class<FlameLight>(module, "FlameLight")
      .def(py::init([](const std::vector<std::array<float, 3>>& visible, float soot,
                       const std::array<float, 3>& soot_light, double coolest, double hottest,
                       const std::vector<std::array<float, 3>>& extinction, float dim) {
             if (visible.size() < 2) {
               throw std::invalid_argument("visible must have at least two rows");
             }
             return FlameLight{visible, soot_light, soot, coolest, hottest, extinction, dim};
           }),
           py::kw_only(), "visible"_a, "soot"_a, "soot_light"_a, "coolest"_a, "hottest"_a,
           "extinction"_a, "dim"_a);
  Class<FlameVolume, std::shared_ptr<FlameVolume>>(module, "FlameVolume")
      .def(py::init(&make_flames), py::kw_only(), "patches"_a, "spindles"_a, "library"_a, "shape"_a,
           "light"_a, "pixel"_a, "fade"_a, "origin"_a, "time"_a)
      .def("sample", &sample, "points"_a, "fine"_a = 0.0);
  module.def("write_flames", &write, "path"_a, "flames"_a, "voxel_size"_a, py::kw_only(),
             "metadata"_a = py::none());
}

} // namespace firetwin::bindings
