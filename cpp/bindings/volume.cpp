#include "arrays.hpp"
#include "base/check.hpp"
#include "bindings.hpp"
#include "broadcast.hpp"
#include "placed.hpp"
#include "volume/dense.hpp"
#include "volume/levels.hpp"
#include "volume/smoke_occlusion.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using lod::ViewSet;
using volume::VdbSummary;
using Path = std::filesystem::path;

constexpr py::ssize_t longest_side = 1 << 30; // voxels, far below overflow of 32-bit integers

/// Request of a model's grids; owns the arrays of the flames.
class GridRequestArrays {
public:
  GridRequestArrays(const py::object& flame_position, const py::object& flame_power,
                    const std::optional<std::vector<std::string>>& grids, const ViewSet* view_set,
                    const std::optional<io::Metadata>& metadata) {
    if (flame_position.is_none() != flame_power.is_none()) {
      wrong("flame_position", "and flame_power must both be set, or neither");
    }
    if (!flame_power.is_none()) {
      power_ = to_array<double>(flame_power, "flame_power", {-1});
      position_ = to_array<double>(flame_position, "flame_position", {power_.size(), 3});
      check_finite(view(power_), "flame_power");
      check_finite(view(position_), "flame_position");
      wanted.flames = {view(position_), view(power_)};
    }
    for (const std::string& name : grids.value_or(std::vector<std::string>{})) {
      wanted.grids.push_back(volume::smoke_grid(name));
    }
    wanted.view_set = view_set;
    wanted.metadata = metadata.value_or(io::Metadata{});
  }

  volume::GridRequest wanted;

private:
  Array<double> position_;
  Array<double> power_;
};

/// Smoke on levels; owns its arrays.
struct LevelArrays {
  Array<double> latitude;
  Array<double> longitude;
  Array<float> ground;
  Array<float> height;
  Array<float> smoke;
  std::optional<Array<float>> temperature;

  LevelArrays(const py::object& lat, const py::object& lon, const py::object& ground_object,
              const py::object& height_object, const py::object& smoke_object,
              const py::object& kelvin)
      : latitude(to_array<double>(lat, "latitude", {-1})),
        longitude(to_array<double>(lon, "longitude", {-1})),
        ground(to_array<float>(ground_object, "ground", {latitude.size(), longitude.size()})),
        height(to_array<float>(height_object, "height", {-1, latitude.size(), longitude.size()})) {
    const std::vector<py::ssize_t> shape(height.shape(), height.shape() + 3);
    smoke = to_array<float>(smoke_object, "smoke", shape);
    if (!kelvin.is_none()) {
      temperature = to_array<float>(kelvin, "temperature", shape);
    }
    check_finite(view(latitude), "latitude");
    check_finite(view(longitude), "longitude");
    if (shape[0] < 2 || shape[1] < 2 || shape[2] < 2) {
      wrong("height", "must have at least two levels, latitudes and longitudes");
    }
  }

  volume::Levels levels() const {
    return {view(latitude),
            view(longitude),
            view(ground),
            view(height),
            view(smoke),
            temperature ? view(*temperature) : std::span<const float>{},
            static_cast<std::size_t>(height.shape(0))};
  }
};

VdbSummary write_levels(const Path& path, const geo::LocalFrame& frame, const py::object& latitude,
                        const py::object& longitude, const py::object& ground,
                        const py::object& height, const py::object& smoke, double voxel_size,
                        const py::object& temperature, const py::object& flame_position,
                        const py::object& flame_power, const std::optional<io::Metadata>& metadata,
                        const std::optional<std::vector<std::string>>& grids,
                        const ViewSet* view_set) {
  const LevelArrays model(latitude, longitude, ground, height, smoke, temperature);
  const GridRequestArrays arrays(flame_position, flame_power, grids, view_set, metadata);
  const volume::Levels levels = model.levels();
  const py::gil_scoped_release release;
  return volume::write_levels(path, frame, levels, voxel_size, arrays.wanted);
}

VdbSummary write(const Path& path, const std::map<std::string, py::object>& grids,
                 double voxel_size, const Vector& origin, bool half, float tolerance,
                 const std::optional<io::Metadata>& metadata, const ViewSet* view_set,
                 const std::string& within) {
  std::map<std::string, Array<float>> arrays;
  std::map<std::string, volume::DenseField> fields;
  for (const auto& [name, object] : grids) {
    const auto array = to_array<float>(object, name, {-1, -1, -1});
    if (array.size() == 0) {
      wrong(name, "must not be empty");
    }
    if (*std::max_element(array.shape(), array.shape() + 3) > longest_side) {
      wrong(name, "must be at most " + std::to_string(longest_side) + " voxels long");
    }
    const auto side = [&array](py::ssize_t axis) {
      return static_cast<std::int32_t>(array.shape(axis));
    };
    fields[name] = {view(array), {side(0), side(1), side(2)}};
    arrays[name] = array;
  }
  const py::gil_scoped_release release;
  return volume::write_dense(path, fields, {voxel_size, origin, half, tolerance, view_set, within},
                             metadata.value_or(io::Metadata{}));
}

py::tuple occluded_smoke(const py::object& extinction, double voxel_size,
                         const py::object& places_object, const py::object& directions_object,
                         double depth, const Vector& origin, const std::optional<Placed>& beyond) {
  const auto smoke = to_array<float>(extinction, "extinction", {-1, -1, -1});
  const auto places = to_array<double>(places_object, "places", {-1, 3});
  const auto directions = to_array<double>(directions_object, "directions", {-1, 3});
  const volume::VoxelGrid inside = brick(smoke, voxel_size, origin);
  const Beyond outside(beyond);
  auto found = zeros({smoke.shape(0), smoke.shape(1), smoke.shape(2)});
  const std::span<float> out = writable(found);
  volume::OwnedVoxelGrid hides;
  {
    const py::gil_scoped_release release;
    hides =
        volume::occluded_smoke(inside, {view(places), view(directions)}, depth, outside.get(), out);
  }
  return py::make_tuple(found, placed(std::move(hides)));
}

void bind_types(Module& module) {
  Class<VdbSummary>(module, "VdbSummary")
      .def_readonly("active_voxels", &VdbSummary::active_voxels)
      .def_readonly("voxels", &VdbSummary::voxels)
      .def_readonly("bytes", &VdbSummary::bytes)
      .def_readonly("mass", &VdbSummary::mass)
      .def_readonly("culled_mass", &VdbSummary::culled_mass)
      .def_property_readonly("bounds", [](const VdbSummary& frame) {
        return py::array_t<double>({2, 3}, frame.bounds.data());
      });
}

} // namespace

void init_volume(Module module) {
  bind_types(module);
  module.attr("FRESH_SMOKE") = volume::fresh_smoke;
  module.def("write_levels", &write_levels, py::arg("path"), py::arg("frame"), py::arg("latitude"),
             py::arg("longitude"), py::arg("ground"), py::arg("height"), py::arg("smoke"),
             py::arg("voxel_size"), py::arg("temperature") = py::none(),
             py::arg("flame_position") = py::none(), py::arg("flame_power") = py::none(),
             py::arg("metadata") = py::none(), py::arg("grids") = py::none(),
             py::arg("views") = py::none());
  module.def("write", &write, py::arg("path"), py::arg("grids"), py::arg("voxel_size"),
             py::arg("origin") = Vector{}, py::arg("half") = true, py::arg("tolerance") = 0.0F,
             py::arg("metadata") = py::none(), py::arg("views") = py::none(),
             py::arg("within") = "");
  module.def("occluded_smoke", &occluded_smoke, py::arg("extinction"), py::arg("voxel_size"),
             py::arg("places"), py::arg("directions"), py::arg("depth"),
             py::arg("origin") = Vector{}, py::arg("beyond") = py::none());
}

} // namespace firetwin::bindings
