#include "arrays.hpp"
#include "bindings.hpp"
#include "sensor/image.hpp"
#include "sensor/planck.hpp"
#include "sensor/thermal.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>
#include <utility>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using sensor::Band;

/// Applies `function(value, band)` to every element.
template <class Function>
Array<double> each(const py::object& object, const std::string& name,
                   std::pair<double, double> limits, Function function) {
  const auto values = to_array<double>(object, name);
  const Band band{limits.first, limits.second};
  sensor::check(band);
  auto result = new_array<double>({values.shape(), values.shape() + values.ndim()});
  const auto in = view(values);
  const auto out = writable(result);
  const py::gil_scoped_release release;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, in.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      out[i] = function(in[i], band);
    }
  });
  return result;
}

Array<double> radiance(const py::object& kelvin, std::pair<double, double> band) {
  return each(kelvin, "kelvin", band, &sensor::radiance);
}

Array<double> brightness_temperature(const py::object& radiance, std::pair<double, double> band) {
  return each(radiance, "radiance", band, &sensor::brightness_temperature);
}

Array<float> thermal_composite(const py::object& rgb, const py::object& kelvin, double low,
                               double high, double strength) {
  const auto k = to_array<float>(kelvin, "kelvin", {-1, -1});
  if (py::array::ensure(rgb) && py::array::ensure(rgb).dtype().kind() != 'f') {
    wrong("rgb", "must be normalised to 0..1 and floating point; divide 8-bit pixels by 255");
  }
  const auto pixels = to_array<float>(rgb, "rgb", {k.shape(0), k.shape(1), 3});
  auto colour = new_array<float>({k.shape(0), k.shape(1), 3});
  const auto out = writable(colour);
  const py::gil_scoped_release release;
  sensor::thermal_composite(view(pixels), view(k), low, high, strength, out);
  return colour;
}

Array<float> read_image(const std::filesystem::path& path) {
  sensor::Image image;
  {
    const py::gil_scoped_release release;
    image = sensor::read_image(path);
  }
  return give(std::move(image.pixels),
              {length(image.height), length(image.width), length(image.channels)});
}

void write_image(const std::filesystem::path& path, const py::object& pixels,
                 const std::optional<io::Metadata>& metadata) {
  const auto image = to_array<float>(pixels, "pixels");
  if (image.ndim() != 2 && image.ndim() != 3) {
    wrong("pixels", "must have shape (h, w) or (h, w, channels), not " + shape_text(image));
  }
  const auto size = [&](py::ssize_t axis) { return static_cast<std::size_t>(image.shape(axis)); };
  const std::size_t channels = image.ndim() == 3 ? size(2) : 1;
  const py::gil_scoped_release release;
  sensor::write_image(path, view(image), size(0), size(1), channels,
                      metadata.value_or(io::Metadata{}));
}

} // namespace

void init_sensor(Module module) {
  const std::pair<double, double> long_wave{8.0, 14.0};
  module.def("radiance", &radiance, py::arg("kelvin"), py::arg("band") = long_wave);
  module.def("brightness_temperature", &brightness_temperature, py::arg("radiance"),
             py::arg("band") = long_wave);
  module.def("thermal_composite", &thermal_composite, py::arg("rgb"), py::arg("kelvin"),
             py::arg("low"), py::arg("high"), py::arg("strength") = 1.0);
  module.def("read_image", &read_image, py::arg("path"));
  module.def("write_image", &write_image, py::arg("path"), py::arg("pixels"),
             py::arg("metadata") = py::none());
}

} // namespace firetwin::bindings
