#include "run/run.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "flux/arrival.hpp"
#include "io/file.hpp"
#include "io/name.hpp"
#include "run/grid_file.hpp"
#include "run/read_ahead.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <stdexcept>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using run::Run;
using run::Series;

Array<float> read_grid(const std::filesystem::path& path) {
  Grid<float> grid;
  {
    const py::gil_scoped_release release;
    grid = run::read_grid(path);
  }
  return give(std::move(grid.values), {length(grid.rows), length(grid.columns)});
}

py::bytes read_description(const std::filesystem::path& folder) {
  constexpr std::uint64_t largest = 16U << 20;
  Buffer<char> bytes;
  {
    const py::gil_scoped_release release;
    bytes = io::read_all(run::Folder(folder).file("run.toml"), largest);
  }
  return {bytes.data(), bytes.size()};
}

// NOLINTNEXTLINE(bugprone-easily-swappable-parameters): keywords in Python
std::shared_ptr<Run> open(const std::filesystem::path& folder, std::string name, std::string start,
                          int offset, std::string vertical, std::optional<double> interval_s,
                          std::vector<double> times_s, double zero_s, std::optional<double> mean_s,
                          std::optional<double> no_data, bool synthetic, std::string event,
                          std::string zone, std::vector<std::string> warnings) {
  const py::gil_scoped_release release;
  return std::make_shared<Run>(
      folder, run::Description{std::move(name), std::move(start), offset, std::move(vertical),
                               interval_s, std::move(times_s), zero_s, mean_s, no_data, synthetic,
                               std::move(event), std::move(zone), std::move(warnings)});
}

std::vector<py::ssize_t> grid_shape(const Run& run) {
  return {length(run.latitude().size()), length(run.longitude().size())};
}

std::vector<py::ssize_t> fuel_shape(const Run& run) {
  return {length(run.fuel_latitude().size()), length(run.fuel_longitude().size())};
}

std::vector<py::ssize_t> shape_of(const Series& series) {
  return {length(series.rows()), length(series.columns())};
}

Array<float> frame(const Series& series, py::ssize_t index) {
  if (index < 0) {
    throw std::out_of_range("time index " + std::to_string(index) + " is negative");
  }
  auto array = new_array<float>(shape_of(series));
  const auto out = writable(array);
  const py::gil_scoped_release release;
  series.read(static_cast<std::size_t>(index), out);
  return array;
}

using Levels = const run::LevelSeries& (Run::*)() const;

Array<float> new_levels(const Run& run, const run::LevelSeries& series) {
  return new_array<float>({length(series.levels()), length(run.air_latitude().size()),
                           length(run.air_longitude().size())});
}

/// A field on levels at times[index].
template <Levels field> Array<float> level_values(const Run& run, py::ssize_t index) {
  if (index < 0) {
    throw std::out_of_range("time index " + std::to_string(index) + " is negative");
  }
  const run::LevelSeries& series = (run.*field)();
  auto array = new_levels(run, series);
  const auto out = writable(array);
  const py::gil_scoped_release release;
  series.read(static_cast<std::size_t>(index), out);
  return array;
}

/// A field on levels at a time between the first and the last.
template <Levels field> Array<float> levels_at(const Run& run, double time) {
  const run::LevelSeries& series = (run.*field)();
  if (!(time >= run.times().front() && time <= run.times().back())) {
    throw py::value_error("time " + std::to_string(time) + " s is outside of the run");
  }
  auto array = new_levels(run, series);
  const auto out = writable(array);
  const py::gil_scoped_release release;
  series.read_at(time, run.times(), out);
  return array;
}

const Series& series_of(const Run& run, const std::string& field) {
  if (field == "heat_flux") {
    return run.heat_flux();
  }
  if (field == "burned_fraction") {
    return run.burned_fraction();
  }
  if (field == "temperature") {
    return run.temperature();
  }
  if (field == "wind_east") {
    return run.wind_east();
  }
  if (field == "wind_north") {
    return run.wind_north();
  }
  throw py::value_error(
      "no series is called '" + field +
      "'; choose heat_flux, burned_fraction, temperature, wind_east or wind_north");
}

std::vector<std::size_t> chosen(const Series& series, const py::object& indices) {
  std::vector<std::size_t> result(series.size());
  std::iota(result.begin(), result.end(), std::size_t{0});
  if (indices.is_none()) {
    return result;
  }
  const auto given = to_array<std::int64_t>(indices, "indices", {-1});
  result.clear();
  for (const std::int64_t index : view(given)) {
    if (index < 0 || static_cast<std::size_t>(index) >= series.size()) {
      throw std::out_of_range("time index " + std::to_string(index) + " of a run with " +
                              std::to_string(series.size()) + " times");
    }
    result.push_back(static_cast<std::size_t>(index));
  }
  return result;
}

/// Iterator over frames; keeps its run alive.
class Frames {
public:
  Frames(std::shared_ptr<const Run> run, const std::string& field, const py::object& indices,
         std::size_t ahead)
      : run_(std::move(run)), shape_(shape_of(series_of(*run_, field))),
        frames_(series_of(*run_, field), chosen(series_of(*run_, field), indices), ahead,
                ahead_threads) {}

  Array<float> next() {
    std::vector<float> frame;
    bool found = false;
    {
      const py::gil_scoped_release release;
      found = frames_.next(frame);
    }
    if (!found) {
      throw py::stop_iteration();
    }
    return give(std::move(frame), shape_);
  }

private:
  /// Reading is cheap compared with most uses of a frame.
  static constexpr std::size_t ahead_threads = 2;
  std::shared_ptr<const Run> run_;
  std::vector<py::ssize_t> shape_;
  run::ReadAhead frames_;
};

std::unique_ptr<Frames> frames(std::shared_ptr<const Run> run, const std::string& field,
                               const py::object& indices, py::ssize_t ahead) {
  if (ahead < 1) {
    wrong("ahead", "must be 1 or more");
  }
  return std::make_unique<Frames>(std::move(run), field, indices, static_cast<std::size_t>(ahead));
}

py::tuple wind(const Run& run, py::ssize_t index) {
  return py::make_tuple(frame(run.wind_east(), index), frame(run.wind_north(), index));
}

py::tuple flux_range(const Run& run) {
  std::pair<float, float> range;
  {
    const py::gil_scoped_release release;
    range = run.flux_range();
  }
  return py::make_tuple(double{range.first}, double{range.second});
}

Array<double> arrival_time(const Run& run) {
  std::vector<double> times;
  {
    const py::gil_scoped_release release;
    times = flux::arrival_time(run);
  }
  return give(std::move(times), grid_shape(run));
}

Array<double> fuel_arrival_time(const Run& run) {
  std::vector<double> times;
  {
    const py::gil_scoped_release release;
    times = flux::fuel_arrival_time(run);
  }
  return give(std::move(times), fuel_shape(run));
}

Array<double> heat_released(const Run& run) {
  std::vector<double> heat;
  {
    const py::gil_scoped_release release;
    const auto& cells = run.scan().cells;
    heat.resize(cells.size());
    std::transform(cells.begin(), cells.end(), heat.begin(), [](const auto& c) { return c.heat; });
  }
  return give(std::move(heat), grid_shape(run));
}

using Axis = const std::vector<double>& (Run::*)() const;
using Field = const run::Plane& (Run::*)() const;

/// Read-only views of the run's memory.
template <Axis axis> Array<double> axis_view(const py::object& self) {
  const auto& values = (self.cast<const Run&>().*axis)();
  return lend<double>(values, {length(values.size())}, self);
}
Array<float> elevation_view(const py::object& self) {
  const Run& run = self.cast<const Run&>();
  return lend<float>(run.elevation(), grid_shape(run), self);
}
template <Field field> Array<float> fuel_view(const py::object& self) {
  const Run& run = self.cast<const Run&>();
  const std::vector<float>& values = [&]() -> const std::vector<float>& {
    const py::gil_scoped_release release;
    return (run.*field)().values();
  }();
  return lend<float>(values, fuel_shape(run), self);
}

const run::Plane& plane_of(const Run& run, const std::string& field) {
  if (field == "surface_fuel") {
    return run.surface_fuel();
  }
  if (field == "canopy_fuel") {
    return run.canopy_fuel();
  }
  if (field == "fuel_elevation") {
    return run.fuel_elevation();
  }
  if (field == "fuel_arrival_time") {
    return run.own_arrival_time();
  }
  if (field == "fuel_category") {
    return run.fuel_category();
  }
  throw py::value_error("no field of the fuel grid is called '" + field +
                        "'; choose surface_fuel, canopy_fuel, fuel_elevation, fuel_category or "
                        "fuel_arrival_time");
}

Array<float> fuel_rows(const Run& run, const std::string& field, py::ssize_t first,
                       py::ssize_t last) {
  const py::ssize_t rows = length(run.fuel_latitude().size());
  if (first < 0 || last < first || last > rows) {
    throw std::out_of_range("rows " + std::to_string(first) + " to " + std::to_string(last) +
                            " of a fuel grid with " + std::to_string(rows) + " rows");
  }
  auto array = new_array<float>({last - first, length(run.fuel_longitude().size())});
  const auto out = writable(array);
  const py::gil_scoped_release release;
  plane_of(run, field).read(static_cast<std::size_t>(first), out);
  return array;
}

/// The path as a Python string that opens the folder even if its name is not valid UTF-8.
py::object path_of(const Run& run) {
  const std::string bytes = io::utf8(run.path());
  PyObject* decoded =
      PyUnicode_DecodeFSDefaultAndSize(bytes.data(), static_cast<py::ssize_t>(bytes.size()));
  if (decoded == nullptr) {
    throw py::error_already_set();
  }
  return py::reinterpret_steal<py::object>(decoded);
}

py::list warnings(const Run& run) {
  py::list result;
  for (const std::string& warning : run.warnings()) {
    result.append(readable(warning));
  }
  return result;
}

py::str describe(const Run& run) {
  return readable("<Run '" + run.description().name +
                  "': " + std::to_string(run.latitude().size()) + " x " +
                  std::to_string(run.longitude().size()) + " cells, " +
                  std::to_string(run.times().size()) + " times>");
}

} // namespace

void init_run(Module module) {
  const auto names = run::field_names();
  module.attr("FIELDS") = std::vector<std::string>(names.begin(), names.end());
  module.def("read_grid", &read_grid, py::arg("path"));
  module.def("read_description", &read_description, py::arg("folder"));
  module.def("open", &open, py::arg("folder"), py::kw_only(), py::arg("name"), py::arg("start"),
             py::arg("offset") = 0, py::arg("vertical") = "orthometric",
             py::arg("interval_s") = py::none(), py::arg("times_s") = std::vector<double>(),
             py::arg("zero_s") = 0.0, py::arg("mean_s") = py::none(),
             py::arg("no_data") = py::none(), py::arg("synthetic") = false, py::arg("event") = "",
             py::arg("zone") = "", py::arg("warnings") = std::vector<std::string>());
  Class<Frames>(module, "Frames")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &Frames::next);
  Class<Run, std::shared_ptr<Run>>(module, "Run")
      .def_property_readonly("path", &path_of)
      .def_property_readonly("name", [](const Run& r) { return readable(r.description().name); })
      .def_property_readonly("synthetic", [](const Run& r) { return r.description().synthetic; })
      .def_property_readonly("offset", [](const Run& r) { return r.description().offset; })
      .def_property_readonly("zone", [](const Run& r) { return r.description().zone; })
      .def_property_readonly("event", [](const Run& r) { return r.description().event; })
      .def_property_readonly("start", [](const Run& r) { return r.description().start; })
      .def_property_readonly("mean_s", [](const Run& r) { return r.description().mean_s; })
      .def_property_readonly("vertical", [](const Run& r) { return r.description().vertical; })
      .def_property_readonly("times", &axis_view<&Run::times>)
      .def_property_readonly("latitude", &axis_view<&Run::latitude>)
      .def_property_readonly("longitude", &axis_view<&Run::longitude>)
      .def_property_readonly("elevation", &elevation_view)
      .def_property_readonly("fuel_latitude", &axis_view<&Run::fuel_latitude>)
      .def_property_readonly("fuel_longitude", &axis_view<&Run::fuel_longitude>)
      .def_property_readonly("air_latitude", &axis_view<&Run::air_latitude>)
      .def_property_readonly("air_longitude", &axis_view<&Run::air_longitude>)
      .def_property_readonly("surface_fuel", &fuel_view<&Run::surface_fuel>)
      .def_property_readonly("canopy_fuel", &fuel_view<&Run::canopy_fuel>)
      .def_property_readonly("fuel_elevation", &fuel_view<&Run::fuel_elevation>)
      .def_property_readonly("fields", &Run::fields)
      .def_property_readonly("warnings", &warnings)
      .def(
          "heat_flux", [](const Run& r, py::ssize_t i) { return frame(r.heat_flux(), i); },
          py::arg("index"))
      .def(
          "burned_fraction",
          [](const Run& r, py::ssize_t i) { return frame(r.burned_fraction(), i); },
          py::arg("index"))
      .def(
          "temperature", [](const Run& r, py::ssize_t i) { return frame(r.temperature(), i); },
          py::arg("index"))
      .def("wind", &wind, py::arg("index"))
      .def("has", &Run::has, py::arg("field"))
      .def("smoke_3d", &level_values<&Run::smoke_3d>, py::arg("index"))
      .def("height_3d", &level_values<&Run::height_3d>, py::arg("index"))
      .def("temperature_3d", &level_values<&Run::temperature_3d>, py::arg("index"))
      .def("smoke_3d_at", &levels_at<&Run::smoke_3d>, py::arg("time"))
      .def("height_3d_at", &levels_at<&Run::height_3d>, py::arg("time"))
      .def("temperature_3d_at", &levels_at<&Run::temperature_3d>, py::arg("time"))
      .def("frames", &frames, py::arg("field") = "heat_flux", py::arg("indices") = py::none(),
           py::arg("ahead") = 8)
      .def("fuel_rows", &fuel_rows, py::arg("field"), py::arg("first"), py::arg("last"))
      .def("flux_range", &flux_range)
      .def("heat_released", &heat_released)
      .def("arrival_time", &arrival_time)
      .def("fuel_arrival_time", &fuel_arrival_time)
      .def("__repr__", &describe);
}

} // namespace firetwin::bindings
