#include "bindings.hpp"

#include "error.hpp"
#include "volume/levels.hpp"
#include "volume/puffs.hpp"
#include "volume/smoke.hpp"
#include "volume/vdb.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

template <typename T> using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

template <typename T> std::span<const T> view(const Array<T>& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

/// A read-only array over a vector that `owner` keeps alive.
template <typename T>
py::array view_of(py::handle owner, const std::vector<T>& values, py::ssize_t columns = 1) {
  const auto rows = static_cast<py::ssize_t>(values.size()) / columns;
  std::vector<py::ssize_t> shape{rows};
  if (columns > 1) {
    shape.push_back(columns);
  }
  py::array_t<T> array(shape, values.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// Throws unless `array` has `shape` and holds finite numbers.
void require(const Array<double>& array, const std::vector<py::ssize_t>& shape,
             const std::string& name) {
  bool fits = array.ndim() == static_cast<py::ssize_t>(shape.size());
  for (std::size_t i = 0; fits && i < shape.size(); ++i) {
    fits = array.shape(static_cast<py::ssize_t>(i)) == shape[i];
  }
  if (!fits) {
    std::string text = name + " must have shape (";
    for (std::size_t i = 0; i < shape.size(); ++i) {
      text += (i > 0 ? ", " : "") + std::to_string(shape[i]);
    }
    throw Error(text + ")");
  }
  for (const double value : view(array)) {
    if (!std::isfinite(value)) {
      throw Error(name + " must be finite; leave out cells that never burn");
    }
  }
}

void require_positive(double value, const char* name) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw Error(std::string(name) + " must be positive and finite");
  }
}

Puffs make_puffs(double time, const Array<double>& arrival, const Array<double>& fuel,
                 const Array<double>& position, Array<double> wind, double cell_area,
                 const PuffSettings& settings) {
  const py::ssize_t cells = arrival.size();
  require(arrival, {cells}, "arrival");
  require(fuel, {cells}, "fuel");
  require(position, {cells, 3}, "position");
  if (wind.ndim() == 1 && wind.size() == 2) {
    const double east = wind.data()[0];
    const double north = wind.data()[1];
    wind = Array<double>(std::vector<py::ssize_t>{cells, 2});
    auto values = wind.mutable_unchecked<2>();
    for (py::ssize_t i = 0; i < cells; ++i) {
      values(i, 0) = east;
      values(i, 1) = north;
    }
  }
  require(wind, {cells, 2}, "wind");
  require_positive(cell_area, "cell_area");
  require_positive(settings.interval, "interval");
  require_positive(settings.max_age, "max_age");
  require_positive(settings.burn_time, "burn_time");
  require_positive(settings.stability, "stability");
  require_positive(settings.block, "block");
  require_positive(settings.merge_radius, "merge_radius");
  require_positive(settings.smallest, "smallest");
  require_positive(settings.smoke_fraction, "smoke_fraction");
  require_positive(settings.heat_of_combustion, "heat_of_combustion");
  if (!std::isfinite(time)) {
    throw Error("time must be finite");
  }
  const Burn burn{view(arrival), view(fuel), view(position), view(wind), cell_area};
  const py::gil_scoped_release release;
  return puffs(time, burn, settings);
}

/// Flames of two arrays that stay alive, or none.
Flames make_flames(const std::optional<Array<double>>& position,
                   const std::optional<Array<double>>& power) {
  if (position.has_value() != power.has_value()) {
    throw Error("give flame_position and flame_power together");
  }
  if (!power) {
    return {};
  }
  require(*power, {power->size()}, "flame_power");
  require(*position, {power->size(), 3}, "flame_position");
  return {view(*position), view(*power)};
}

Sight make_sight(const Array<double>& camera, const Array<double>& rotation,
                 const Array<double>& fov, const std::array<double, 3>& sun, double floor) {
  const py::ssize_t views = camera.ndim() == 2 ? camera.shape(0) : 0;
  require(camera, {views, 3}, "camera");
  require(rotation, {views, 3, 3}, "rotation");
  require(fov, {views, 2}, "fov");
  Sight sight;
  for (py::ssize_t i = 0; i < views; ++i) {
    lod::View view{};
    std::copy_n(camera.data() + 3 * i, 3, view.position.begin());
    std::copy_n(rotation.data() + 9 * i, 9, view.to_world.begin());
    view.width = fov.at(i, 0);
    view.height = fov.at(i, 1);
    sight.cameras.emplace_back(view, 0.0, std::numeric_limits<double>::infinity());
  }
  sight.sun = sun;
  sight.floor = floor;
  return sight;
}

Wanted make_wanted(const std::optional<Array<double>>& position,
                   const std::optional<Array<double>>& power,
                   const std::optional<std::vector<std::string>>& grids,
                   const std::optional<Sight>& sight, const std::optional<Metadata>& metadata) {
  Wanted wanted;
  wanted.flames = make_flames(position, power);
  for (const std::string& name : grids.value_or(std::vector<std::string>{})) {
    wanted.grids.push_back(smoke_grid(name));
  }
  wanted.sight = sight.value_or(Sight{});
  wanted.metadata = metadata.value_or(Metadata{});
  return wanted;
}

VolumeFrame smoke_file(const std::filesystem::path& path, const Puffs& smoke, double voxel_size,
                       const std::optional<Array<double>>& position,
                       const std::optional<Array<double>>& power,
                       const std::optional<Metadata>& metadata,
                       const std::optional<std::vector<std::string>>& grids,
                       const std::optional<Sight>& sight) {
  const Wanted wanted = make_wanted(position, power, grids, sight, metadata);
  const py::gil_scoped_release release;
  return write_smoke(path.string(), smoke, voxel_size, wanted);
}

/// Throws unless `array` has `shape`.
void require_shape(const Array<float>& array, const std::vector<py::ssize_t>& shape,
                   const std::string& name) {
  const std::vector<py::ssize_t> found(array.shape(), array.shape() + array.ndim());
  if (found != shape) {
    throw Error(name + " must fit latitude, longitude and height (nz, ny, nx)");
  }
}

VolumeFrame levels_file(
    const std::filesystem::path& path, const geo::LocalFrame& frame, const Array<double>& latitude,
    const Array<double>& longitude, const Array<float>& ground, const Array<float>& height,
    const Array<float>& smoke, double voxel_size, const std::optional<Array<float>>& temperature,
    const std::optional<Array<double>>& position, const std::optional<Array<double>>& power,
    const std::optional<Metadata>& metadata, const std::optional<std::vector<std::string>>& grids,
    const std::optional<Sight>& sight) {
  const py::ssize_t ny = latitude.size();
  const py::ssize_t nx = longitude.size();
  require(latitude, {ny}, "latitude");
  require(longitude, {nx}, "longitude");
  if (height.ndim() != 3 || height.shape(0) < 2 || ny < 2 || nx < 2) {
    throw Error("height must have shape (nz, ny, nx), each 2 or more");
  }
  const py::ssize_t nz = height.shape(0);
  require_shape(ground, {ny, nx}, "ground");
  require_shape(height, {nz, ny, nx}, "height");
  require_shape(smoke, {nz, ny, nx}, "smoke");
  if (temperature) {
    require_shape(*temperature, {nz, ny, nx}, "temperature");
  }
  const Wanted wanted = make_wanted(position, power, grids, sight, metadata);
  const Levels levels{view(latitude),
                      view(longitude),
                      view(ground),
                      view(height),
                      view(smoke),
                      temperature ? view(*temperature) : std::span<const float>{},
                      static_cast<std::size_t>(nz)};
  const py::gil_scoped_release release;
  return write_levels(path.string(), frame, levels, voxel_size, wanted);
}

VolumeFrame dense_file(const std::filesystem::path& path,
                       const std::map<std::string, Array<float>>& grids, double voxel_size,
                       const std::array<double, 3>& origin, bool half, float tolerance,
                       const std::optional<Metadata>& metadata) {
  std::map<std::string, DenseField> fields;
  for (const auto& [name, array] : grids) {
    if (array.ndim() != 3 || array.size() == 0) {
      throw Error("grid \"" + name + "\" must have shape (nx, ny, nz), none of them 0");
    }
    fields[name] = {view(array),
                    {static_cast<std::int32_t>(array.shape(0)),
                     static_cast<std::int32_t>(array.shape(1)),
                     static_cast<std::int32_t>(array.shape(2))}};
  }
  const py::gil_scoped_release release;
  return write_dense(path.string(), fields, voxel_size, origin, half, tolerance,
                     metadata.value_or(Metadata{}));
}

void bind_types(py::module_& module) {
  py::class_<Puffs>(module, "Puffs", "Smoke of one moment as n balls.")
      .def_property_readonly(
          "position",
          [](py::object self) { return view_of(self, self.cast<const Puffs&>().position, 3); })
      .def_property_readonly(
          "radius", [](py::object self) { return view_of(self, self.cast<const Puffs&>().radius); })
      .def_property_readonly(
          "density",
          [](py::object self) { return view_of(self, self.cast<const Puffs&>().density); })
      .def_property_readonly(
          "age", [](py::object self) { return view_of(self, self.cast<const Puffs&>().age); })
      .def_property_readonly(
          "mass", [](py::object self) { return view_of(self, self.cast<const Puffs&>().mass); })
      .def_property_readonly(
          "identity",
          [](py::object self) { return view_of(self, self.cast<const Puffs&>().identity); })
      .def_readonly("emitted", &Puffs::emitted)
      .def_readonly("left", &Puffs::left)
      .def("__len__", &Puffs::size);
  py::class_<Sight>(module, "Sight", "What the cameras of a moment see, and what shadows it.")
      .def(py::init(&make_sight), py::arg("camera"), py::arg("rotation"), py::arg("fov"),
           py::arg("sun") = std::array<double, 3>{}, py::arg("floor") = 0.0)
      .def("counts", &Sight::counts, py::arg("centre"), py::arg("radius"),
           "Whether a ball is in view or throws its shadow on a place that is.");
  py::class_<VolumeFrame>(module, "Frame", "What one VDB file holds.")
      .def_readonly("active_voxels", &VolumeFrame::active_voxels)
      .def_readonly("voxels", &VolumeFrame::voxels)
      .def_readonly("bytes", &VolumeFrame::bytes)
      .def_readonly("mass", &VolumeFrame::mass)
      .def_readonly("hidden", &VolumeFrame::hidden)
      .def_property_readonly("bounds", [](const VolumeFrame& frame) {
        return py::array_t<double>({2, 3}, frame.bounds.data());
      });
}

} // namespace

void init_volume(py::module_ module) {
  module.doc() = "Smoke and flames as OpenVDB volumes.";
  bind_types(module);
  module.attr("FRESH_SMOKE") = kFreshSmoke;
  const PuffSettings defaults;
  module.def(
      "puffs",
      [](double time, const Array<double>& arrival, const Array<double>& fuel,
         const Array<double>& position, const Array<double>& wind, double cell_area,
         double interval, double max_age, double burn_time, double stability, std::uint64_t seed,
         double smoke_fraction, double heat_of_combustion, double block, double merge_radius,
         double smallest, double turbulence) {
        return make_puffs(time, arrival, fuel, position, wind, cell_area,
                          {interval, max_age, burn_time, stability, block, merge_radius, smallest,
                           turbulence, smoke_fraction, heat_of_combustion, seed});
      },
      py::arg("time"), py::arg("arrival"), py::arg("fuel"), py::arg("position"), py::arg("wind"),
      py::arg("cell_area"), py::arg("interval") = defaults.interval,
      py::arg("max_age") = defaults.max_age, py::arg("burn_time") = defaults.burn_time,
      py::arg("stability") = defaults.stability, py::arg("seed") = defaults.seed,
      py::arg("smoke_fraction") = defaults.smoke_fraction,
      py::arg("heat_of_combustion") = defaults.heat_of_combustion,
      py::arg("block") = defaults.block, py::arg("merge_radius") = defaults.merge_radius,
      py::arg("smallest") = defaults.smallest, py::arg("turbulence") = defaults.turbulence,
      "Closed-form puffs at `time` from cells that burned.");
  module.def("write_smoke", &smoke_file, py::arg("path"), py::arg("puffs"), py::arg("voxel_size"),
             py::arg("flame_position") = py::none(), py::arg("flame_power") = py::none(),
             py::arg("metadata") = py::none(), py::arg("grids") = py::none(),
             py::arg("sight") = py::none(), "Write the puffs as a smoke volume.");
  module.def("write_levels", &levels_file, py::arg("path"), py::arg("frame"), py::arg("latitude"),
             py::arg("longitude"), py::arg("ground"), py::arg("height"), py::arg("smoke"),
             py::arg("voxel_size"), py::arg("temperature") = py::none(),
             py::arg("flame_position") = py::none(), py::arg("flame_power") = py::none(),
             py::arg("metadata") = py::none(), py::arg("grids") = py::none(),
             py::arg("sight") = py::none(),
             "Write smoke on terrain-following levels as a smoke volume.");
  module.def("write", &dense_file, py::arg("path"), py::arg("grids"), py::arg("voxel_size"),
             py::arg("origin") = std::array<double, 3>{0.0, 0.0, 0.0}, py::arg("half") = true,
             py::arg("tolerance") = 0.0F, py::arg("metadata") = py::none(),
             "Write dense arrays (nx, ny, nz) as sparse fog volumes.");
}

} // namespace firetwin::bindings
