#include "arrays.hpp"
#include "bindings.hpp"
#include "sensor/detector.hpp"
#include "sensor/eye_dome.hpp"
#include "sensor/image.hpp"
#include "sensor/palette.hpp"
#include "sensor/planck_table.hpp"
#include "sensor/thermal.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using sensor::Band;

using sensor::PlanckTable;

/// Applies `function(value)` to every element in parallel.
template <class T, class Function>
Array<T> each(const py::object& object, const std::string& name, Function function) {
  const auto values = to_array<T>(object, name);
  auto result = new_array<T>({values.shape(), values.shape() + values.ndim()});
  const auto in = view(values);
  const auto out = writable(result);
  const py::gil_scoped_release release;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, in.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      out[i] = static_cast<T>(function(static_cast<double>(in[i])));
    }
  });
  return result;
}

Band checked(std::pair<double, double> limits) {
  const Band band{limits.first, limits.second};
  sensor::check(band);
  return band;
}

Array<double> radiance(const py::object& kelvin, std::pair<double, double> limits) {
  const Band band = checked(limits);
  return each<double>(kelvin, "kelvin", [&](double k) { return sensor::radiance(k, band); });
}

Array<double> brightness_temperature(const py::object& radiance, std::pair<double, double> limits) {
  const Band band = checked(limits);
  return each<double>(radiance, "radiance",
                      [&](double r) { return sensor::brightness_temperature(r, band); });
}

double checked_wavelength(double micrometres) {
  if (!(micrometres > 0.0) || !std::isfinite(micrometres)) {
    wrong("wavelength", "must be above 0 and finite, in micrometres");
  }
  return micrometres;
}

Array<double> spectral_radiance(const py::object& kelvin, double wavelength) {
  checked_wavelength(wavelength);
  return each<double>(kelvin, "kelvin",
                      [&](double k) { return sensor::spectral_radiance(k, wavelength); });
}

Array<double> spectral_temperature(const py::object& radiance, double wavelength) {
  checked_wavelength(wavelength);
  return each<double>(radiance, "radiance",
                      [&](double r) { return sensor::spectral_temperature(r, wavelength); });
}

Array<float> table_radiance(const PlanckTable& table, const py::object& kelvin) {
  return each<float>(kelvin, "kelvin", [&](double k) { return table.radiance(k); });
}

Array<float> table_temperature(const PlanckTable& table, const py::object& radiance) {
  return each<float>(radiance, "radiance", [&](double r) { return table.temperature(r); });
}

py::tuple detect(const PlanckTable& table, const py::object& radiance, double blur, double noise,
                 double saturation, int bits, std::uint64_t key) {
  const sensor::Detector detector{blur, noise, saturation, bits};
  sensor::check(detector);
  const auto in = to_array<float>(radiance, "radiance", {-1, -1});
  auto measured = new_array<float>({in.shape(0), in.shape(1)});
  auto counts = new_array<std::uint16_t>({in.shape(0), bits > 0 ? in.shape(1) : 0});
  const auto out = writable(measured);
  const auto whole = writable(counts);
  std::ranges::copy(view(in), out.begin());
  {
    const py::gil_scoped_release release;
    sensor::detect(detector, table, key, static_cast<std::size_t>(in.shape(0)),
                   static_cast<std::size_t>(in.shape(1)), out, whole);
  }
  return py::make_tuple(measured, bits > 0 ? py::object(counts) : py::object(py::none()));
}

/// Calls `work(first pixel, count)` for blocks of pixels in parallel.
template <class Work> void in_pieces(std::size_t pixels, Work work) {
  const py::gil_scoped_release release;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels, 4096),
                    [&](const auto& range) { work(range.begin(), range.end() - range.begin()); });
}

Array<float> colour(const py::object& kelvin, double low, double high, const std::string& name,
                    double knee) {
  const auto k = to_array<float>(kelvin, "kelvin", {-1, -1});
  const sensor::Palette& palette = sensor::palette(name);
  auto result = new_array<float>({k.shape(0), k.shape(1), 3});
  const auto in = view(k);
  const auto out = writable(result);
  sensor::colour({}, low, high, knee, palette, {}); // validates the arguments, without pixels
  in_pieces(in.size(), [&](std::size_t first, std::size_t count) {
    sensor::colour(in.subspan(first, count), low, high, knee, palette,
                   out.subspan(3 * first, 3 * count));
  });
  return result;
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
  const auto in = view(k);
  sensor::thermal_composite({}, {}, low, high, strength, {});
  in_pieces(in.size(), [&](std::size_t first, std::size_t count) {
    sensor::thermal_composite(view(pixels).subspan(3 * first, 3 * count), in.subspan(first, count),
                              low, high, strength, out.subspan(3 * first, 3 * count));
  });
  return colour;
}

Array<float> overlay(const py::object& below, const py::object& above, const py::object& kelvin,
                     double start, double full, double opacity) {
  const auto k = to_array<float>(kelvin, "kelvin", {-1, -1});
  const auto under = to_array<float>(below, "below", {k.shape(0), k.shape(1), 3});
  const auto over = to_array<float>(above, "above", {k.shape(0), k.shape(1), 3});
  auto colour = new_array<float>({k.shape(0), k.shape(1), 3});
  const auto out = writable(colour);
  const auto in = view(k);
  sensor::overlay({}, {}, {}, start, full, opacity, {});
  in_pieces(in.size(), [&](std::size_t first, std::size_t count) {
    sensor::overlay(view(under).subspan(3 * first, 3 * count),
                    view(over).subspan(3 * first, 3 * count), in.subspan(first, count), start, full,
                    opacity, out.subspan(3 * first, 3 * count));
  });
  return colour;
}

Array<double> palette(const std::string& name) {
  const auto stops = sensor::palette(name).stops;
  auto result = new_array<double>({length(stops.size()), 3});
  auto next = writable(result).begin();
  for (const sensor::Colour& stop : stops) {
    next = std::ranges::copy(stop, next).out;
  }
  return result;
}

Array<float> eye_dome(const py::object& depth, double strength, std::size_t radius) {
  const auto metres = to_array<float>(depth, "depth", {-1, -1});
  auto shade = new_array<float>({metres.shape(0), metres.shape(1)});
  const auto out = writable(shade);
  const py::gil_scoped_release release;
  sensor::eye_dome(view(metres), static_cast<std::size_t>(metres.shape(0)),
                   static_cast<std::size_t>(metres.shape(1)), strength, radius, out);
  return shade;
}

sensor::Image load(const std::filesystem::path& path) {
  const py::gil_scoped_release release;
  return sensor::read_image(path);
}

/// Moves an image's pixels to NumPy.
Array<float> pixels_of(sensor::Image& image) {
  return give(std::move(image.pixels),
              {length(image.height), length(image.width), length(image.channels)});
}

Array<float> read_image(const std::filesystem::path& path) {
  sensor::Image image = load(path);
  return pixels_of(image);
}

Array<float> decode_image(const py::bytes& data, const std::string& name) {
  const std::string_view bytes = data;
  sensor::Image image;
  {
    const py::gil_scoped_release release;
    image = sensor::decode_image(
        {reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()}, name);
  }
  return pixels_of(image);
}

py::dict read_channels(const std::filesystem::path& path) {
  sensor::Image image = load(path);
  const py::array all = pixels_of(image);
  py::dict found;
  for (std::size_t n = 0; n < image.names.size(); ++n) {
    found[py::str(image.names[n])] = all[py::make_tuple(py::ellipsis(), n)];
  }
  return found;
}

/// Height, width and channels.
std::array<std::size_t, 3> image_size(const Array<float>& pixels) {
  if (pixels.ndim() != 2 && pixels.ndim() != 3) {
    wrong("pixels", "must have shape (h, w) or (h, w, channels), not " + shape_text(pixels));
  }
  const auto size = [&](py::ssize_t axis) { return static_cast<std::size_t>(pixels.shape(axis)); };
  return {size(0), size(1), pixels.ndim() == 3 ? size(2) : 1};
}

py::bytes encode_png(const py::object& pixels) {
  const auto image = to_array<float>(pixels, "pixels");
  const auto [height, width, count] = image_size(image);
  std::vector<unsigned char> encoded;
  {
    const py::gil_scoped_release release;
    encoded = sensor::encode_png(view(image), height, width, count);
  }
  return {reinterpret_cast<const char*>(encoded.data()), encoded.size()};
}

template <std::size_t n> std::array<float, n> copied(const Array<float>& array) {
  std::array<float, n> result{};
  std::copy_n(array.data(), n, result.begin());
  return result;
}

/// Converts a value of a header attribute; a fraction is anything with a numerator and denominator.
sensor::Attribute attribute(const std::string& name, const py::handle& value) {
  if (py::isinstance<py::str>(value)) {
    return value.cast<std::string>();
  }
  if (py::isinstance<sensor::TimeCode>(value)) {
    return value.cast<sensor::TimeCode>();
  }
  if (py::isinstance<py::int_>(value)) {
    return value.cast<std::int32_t>();
  }
  if (py::isinstance<py::float_>(value)) {
    return value.cast<float>();
  }
  if (py::hasattr(value, "numerator") && py::hasattr(value, "denominator")) {
    return sensor::Rational{value.attr("numerator").cast<std::int32_t>(),
                            value.attr("denominator").cast<std::uint32_t>()};
  }
  const auto array = to_array<float>(value, "metadata " + name);
  if (array.ndim() == 0) { // such as numpy.float32
    return *array.data();
  }
  if (array.ndim() == 1 && array.size() == 2) {
    return copied<2>(array);
  }
  if (array.ndim() == 1 && array.size() == 3) {
    return copied<3>(array);
  }
  if (array.ndim() == 2 && array.shape(0) == 4 && array.shape(1) == 4) {
    return copied<16>(array);
  }
  wrong("metadata " + name, "must have shape (2,), (3,) or (4, 4), not " + shape_text(array));
}

sensor::TimeCode time_code(unsigned hours, unsigned minutes, unsigned seconds, unsigned frame,
                           bool drop_frame, bool second_field) {
  if (hours > 23 || minutes > 59 || seconds > 59 || frame > 29) {
    throw py::value_error("a time code has at most 23 hours, 59 minutes, 59 seconds and frame 29");
  }
  return {hours, minutes, seconds, frame, drop_frame, second_field};
}

void write_image(const std::filesystem::path& path, const py::object& pixels,
                 const std::optional<py::dict>& metadata,
                 const std::optional<std::vector<std::string>>& names, bool half, bool one_line) {
  const auto image = to_array<float>(pixels, "pixels");
  const auto [height, width, count] = image_size(image);
  if (names && names->size() != count) {
    wrong("names", "must have one name per channel, " + std::to_string(count));
  }
  sensor::Attributes attributes;
  for (const auto& [key, value] : metadata.value_or(py::dict{})) {
    const auto name = key.cast<std::string>();
    attributes[name] = attribute(name, value);
  }
  const py::gil_scoped_release release;
  sensor::write_image(path, view(image), height, width, count, attributes,
                      {names.value_or(std::vector<std::string>{}), half, one_line});
}

} // namespace

void init_sensor(Module module) {
  const std::pair<double, double> long_wave{8.0, 14.0};
  module.def("radiance", &radiance, py::arg("kelvin"), py::arg("band") = long_wave);
  module.def("brightness_temperature", &brightness_temperature, py::arg("radiance"),
             py::arg("band") = long_wave);
  module.def("spectral_radiance", &spectral_radiance, py::arg("kelvin"), py::arg("wavelength"));
  module.def("spectral_temperature", &spectral_temperature, py::arg("radiance"),
             py::arg("wavelength"));
  Class<PlanckTable>(module, "PlanckTable")
      .def(py::init([](std::pair<double, double> limits, std::size_t knots) {
             return PlanckTable(checked(limits), knots);
           }),
           py::arg("band") = long_wave, py::arg("knots") = 512)
      .def("radiance", &table_radiance, py::arg("kelvin"))
      .def("brightness_temperature", &table_temperature, py::arg("radiance"))
      .def("detect", &detect, py::arg("radiance"), py::kw_only(), py::arg("blur") = 0.0,
           py::arg("noise") = 0.0, py::arg("saturation") = 0.0, py::arg("bits") = 0,
           py::arg("key") = 0);
  module.def("palettes", &sensor::palettes);
  module.def("palette", &palette, py::arg("name"));
  module.def("colour", &colour, py::arg("kelvin"), py::arg("low"), py::arg("high"),
             py::arg("palette") = "white-hot", py::arg("knee") = 0.0);
  module.def("thermal_composite", &thermal_composite, py::arg("rgb"), py::arg("kelvin"),
             py::arg("low"), py::arg("high"), py::arg("strength") = 1.0);
  module.def("overlay", &overlay, py::arg("below"), py::arg("above"), py::arg("kelvin"),
             py::arg("start"), py::arg("full"), py::arg("opacity") = 1.0);
  module.def("eye_dome", &eye_dome, py::arg("depth"), py::arg("strength") = 4.0,
             py::arg("radius") = 1);
  module.def("read_image", &read_image, py::arg("path"));
  module.def("decode_image", &decode_image, py::arg("data"), py::arg("name") = "image");
  module.def("encode_png", &encode_png, py::arg("pixels"));
  module.def("read_channels", &read_channels, py::arg("path"));
  module.def("write_image", &write_image, py::arg("path"), py::arg("pixels"),
             py::arg("metadata") = py::none(), py::arg("names") = py::none(), py::kw_only(),
             py::arg("half") = false, py::arg("one_line") = false);
  Class<sensor::TimeCode>(module, "TimeCode")
      .def(py::init(&time_code), py::arg("hours"), py::arg("minutes"), py::arg("seconds"),
           py::arg("frame"), py::kw_only(), py::arg("drop_frame") = false,
           py::arg("second_field") = false);
}

} // namespace firetwin::bindings
