#include "arrays.hpp"
#include "bindings.hpp"
#include "tiles/screen_error.hpp"
#include "tiles/select.hpp"

#include <limits>
#include <utility>
#include <vector>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

/// Bounding volumes of tiles; owns the arrays.
class VolumeArrays {
public:
  VolumeArrays(const py::object& centre, const py::object& axis, const py::object& half,
               const py::object& padding)
      : padding_(to_array<double>(padding, "padding", {-1})),
        centre_(to_array<double>(centre, "centre", {padding_.size(), 3})),
        axis_(to_array<double>(axis, "axis", {padding_.size(), 3, 3})),
        half_(to_array<double>(half, "half", {padding_.size(), 3})) {}

  py::ssize_t size() const { return padding_.size(); }
  tiles::Volumes volumes() const {
    return {view(centre_), view(axis_), view(half_), view(padding_)};
  }

private:
  Array<double> padding_, centre_, axis_, half_;
};

Array<double> screen_error(const py::object& centre, const py::object& axis, const py::object& half,
                           const py::object& padding, const py::object& error,
                           const lod::ViewSet& views, const py::object& pixels, double max_distance,
                           double margin, bool shadows) {
  const VolumeArrays arrays(centre, axis, half, padding);
  const auto errors = to_array<double>(error, "error", {arrays.size()});
  const auto scales = to_array<double>(pixels, "pixels", {-1});
  auto result = new_array<double>({arrays.size()});
  const auto out = writable(result);
  const py::gil_scoped_release release;
  tiles::screen_error(arrays.volumes(), view(errors), views, view(scales),
                      {max_distance, margin, shadows}, out);
  return result;
}

Array<bool> contains_any(const py::object& centre, const py::object& axis, const py::object& half,
                         const py::object& padding, const py::object& position) {
  const VolumeArrays arrays(centre, axis, half, padding);
  const auto places = to_array<double>(position, "position", {-1, 3});
  auto result = new_array<bool>({arrays.size()});
  const auto out = writable(result);
  const py::gil_scoped_release release;
  tiles::contains_any(arrays.volumes(), view(places), out);
  return result;
}

tiles::Cut select(const py::object& parent, const py::object& flags, const py::object& screen_error,
                  const py::object& bytes, const py::object& triangles, double error,
                  std::int64_t max_tiles, std::int64_t max_bytes, std::int64_t max_triangles) {
  const auto parents = to_array<std::int64_t>(parent, "parent", {-1});
  const py::ssize_t n = parents.size();
  const auto bits = to_array<std::uint8_t>(flags, "flags", {n});
  const auto errors = to_array<double>(screen_error, "screen_error", {n});
  const auto sizes = to_array<std::int64_t>(bytes, "bytes", {n});
  const auto counts = to_array<std::int64_t>(triangles, "triangles", {n});
  const py::gil_scoped_release release;
  return tiles::select({view(parents), view(bits), view(errors), view(sizes), view(counts)}, error,
                       {max_tiles, max_bytes, max_triangles});
}

template <std::vector<std::int64_t> tiles::Cut::* member>
Array<std::int64_t> column(const py::object& self) {
  return lend_column(self.cast<const tiles::Cut&>().*member, self);
}

} // namespace

void init_tiles_select(Module module) {
  using tiles::Cut;
  Class<Cut>(module, "Cut")
      .def_property_readonly("tiles", &column<&Cut::tiles>)
      .def_property_readonly("expand", &column<&Cut::expand>)
      .def_property_readonly("stand_ins", &column<&Cut::stand_ins>)
      .def_property_readonly("missing", &column<&Cut::missing>)
      .def_readonly("error", &Cut::error)
      .def_readonly("fits", &Cut::fits)
      .def_readonly("bytes", &Cut::bytes)
      .def_readonly("triangles", &Cut::triangles);
  module.def("screen_error", &screen_error, py::arg("centre"), py::arg("axis"), py::arg("half"),
             py::arg("padding"), py::arg("error"), py::arg("views"), py::arg("pixels"),
             py::arg("max_distance") = std::numeric_limits<double>::infinity(),
             py::arg("margin") = 0.0, py::arg("shadows") = false);
  module.def("contains_any", &contains_any, py::arg("centre"), py::arg("axis"), py::arg("half"),
             py::arg("padding"), py::arg("position"));
  module.def("select", &select, py::arg("parent"), py::arg("flags"), py::arg("screen_error"),
             py::arg("bytes"), py::arg("triangles"), py::arg("error"), py::arg("max_tiles") = -1,
             py::arg("max_bytes") = -1, py::arg("max_triangles") = -1);
  module.attr("REPLACES") = static_cast<int>(tiles::replaces);
  module.attr("UNCONDITIONAL") = static_cast<int>(tiles::unconditional);
  module.attr("CONTENT") = static_cast<int>(tiles::content);
  module.attr("PENDING") = static_cast<int>(tiles::pending);
  module.attr("BROKEN") = static_cast<int>(tiles::broken);
  module.attr("OUTSIDE_REQUEST_VOLUME") = static_cast<int>(tiles::outside_request_volume);
  module.attr("PASS_THROUGH") = static_cast<int>(tiles::pass_through);
}

} // namespace firetwin::bindings
