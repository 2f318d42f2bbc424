#include "volume/march.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "flames/flames.hpp"
#include "volume/flame_distance.hpp"
#include "volume/infrared.hpp"
#include "volume/optical_depth.hpp"

#include <pybind11/stl.h>

#include <memory>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using flames::FlameVolume;
using volume::AirTemperature;
using volume::Bricks;
using volume::Colour;
using volume::Illumination;

std::shared_ptr<Bricks> make_bricks(const py::object& density, const py::object& fresh,
                                    const py::object& sun, const py::object& sky,
                                    const py::object& glow, double voxel_size, const Vector& origin,
                                    const py::object& edge) {
  const auto thick = to_array<float>(density, "density", {-1, -1, -1});
  const std::vector<py::ssize_t> shape{thick.shape(0), thick.shape(1), thick.shape(2)};
  const auto field = [&](const py::object& object, const char* name) {
    return to_array<float>(object, name, shape);
  };
  const auto young = field(fresh, "fresh"), sunlight = field(sun, "sun"),
             skylight = field(sky, "sky");
  const auto light = glow.is_none() ? Array<float>(py::ssize_t{0}) : field(glow, "glow");
  const auto outline = edge.is_none() ? Array<float>(py::ssize_t{0}) : field(edge, "edge");
  const Bricks::Fields fields{view(thick),    view(young), view(sunlight),
                              view(skylight), view(light), view(outline)};
  const py::gil_scoped_release release;
  return std::make_shared<Bricks>(fields, std::array<std::int64_t, 3>{shape[0], shape[1], shape[2]},
                                  voxel_size, origin);
}

/// Converted arrays of rays and layers.
class RayArrays {
public:
  RayArrays(const std::vector<std::shared_ptr<Bricks>>& layers, const py::object& origins,
            const py::object& directions)
      : origins_(to_array<double>(origins, "origins")),
        directions_(to_array<double>(directions, "directions", {-1, 3})) {
    for (const auto& layer : layers) {
      layers_.push_back(layer.get());
    }
  }

  volume::Layers layers() const { return layers_; }
  volume::Rays rays() const { return {view(origins_), view(directions_)}; }
  py::ssize_t size() const { return directions_.shape(0); }

private:
  std::vector<const Bricks*> layers_;
  Array<double> origins_, directions_;
};

/// Hot gases that own their arrays.
class HotGasArrays {
public:
  HotGasArrays(const py::object& excess, const py::object& heights,
               const std::array<double, 2>& first, double spacing)
      : excess_(to_array<float>(excess, "excess", {-1, -1, -1})),
        heights_(to_array<float>(heights, "heights",
                                 {excess_.shape(0), excess_.shape(1), excess_.shape(2)})),
        first_(first), spacing_(spacing) {}

  volume::HotGas view() const {
    return {bindings::view(excess_),
            bindings::view(heights_),
            {excess_.shape(0), excess_.shape(1), excess_.shape(2)},
            first_,
            spacing_};
  }

private:
  Array<float> excess_, heights_;
  std::array<double, 2> first_;
  double spacing_;
};

using LayerList = std::vector<std::shared_ptr<Bricks>>;

Array<float> march(const LayerList& layers, const py::object& origins, const py::object& directions,
                   const py::object& distances, const Illumination& light, double step,
                   double min_transmittance, const std::shared_ptr<FlameVolume>& flames,
                   const std::array<double, 2>& pixel, bool parts) {
  const RayArrays given(layers, origins, directions);
  const auto taps = to_array<float>(distances, "distances", {given.size(), -1});
  auto found = new_array<float>(
      {given.size(), taps.shape(1), static_cast<py::ssize_t>(volume::march_values(parts))});
  const std::span<float> out = writable(found);
  const py::gil_scoped_release release;
  volume::march(given.layers(), flames.get(), given.rays(),
                {view(taps), static_cast<std::size_t>(taps.shape(1))}, light,
                {step, min_transmittance, pixel, parts}, out);
  return found;
}

Array<float> flame_distance(const FlameVolume& flames, const py::object& origins,
                            const py::object& directions, float farthest) {
  const RayArrays given({}, origins, directions);
  auto found = new_array<float>({given.size(), 2});
  const std::span<float> out = writable(found);
  const py::gil_scoped_release release;
  volume::flame_distance(flames, given.rays(), farthest, out);
  return found;
}

Array<float> optical_depth(const LayerList& layers, const py::object& origins,
                           const py::object& directions, const py::object& distances, double step,
                           double max_depth) {
  const RayArrays given(layers, origins, directions);
  const auto ends = to_array<float>(distances, "distances", {given.size()});
  auto found = new_array<float>({given.size()});
  const std::span<float> out = writable(found);
  const py::gil_scoped_release release;
  volume::optical_depth(given.layers(), given.rays(), view(ends), step,
                        static_cast<float>(max_depth), out);
  return found;
}

Array<float> opaque_distance(const LayerList& layers, const py::object& origins,
                             const py::object& directions, double step, float depth) {
  const RayArrays given(layers, origins, directions);
  auto found = new_array<float>({given.size()});
  const std::span<float> out = writable(found);
  const py::gil_scoped_release release;
  volume::opaque_distance(given.layers(), given.rays(), step, depth, out);
  return found;
}

Array<float>
march_infrared(const LayerList& layers, const py::object& origins, const py::object& directions,
               const py::object& distances, const py::object& kelvin, const py::object& elevation,
               const std::array<double, 2>& corner, const std::array<double, 2>& spacing,
               double lapse, const py::object& radiance, double coldest, double kelvin_step,
               double absorption, double step, const std::shared_ptr<FlameVolume>& flames,
               const std::vector<std::shared_ptr<HotGasArrays>>& hot, double gas) {
  const RayArrays given(layers, origins, directions);
  const auto ends = to_array<float>(distances, "distances", {given.size()});
  const auto warm = to_array<float>(kelvin, "kelvin", {-1, -1});
  const auto high = to_array<float>(elevation, "elevation", {warm.shape(0), warm.shape(1)});
  const auto table = to_array<float>(radiance, "radiance", {-1});
  const AirTemperature air{view(warm),  view(high), {warm.shape(0), warm.shape(1)},
                           corner,      spacing,    lapse,
                           view(table), coldest,    kelvin_step,
                           absorption};
  std::vector<volume::HotGas> gases;
  for (const auto& each : hot) {
    gases.push_back(each->view());
  }
  auto found = new_array<float>({given.size(), 2});
  const std::span<float> out = writable(found);
  const py::gil_scoped_release release;
  volume::march_infrared(given.layers(), flames.get(), given.rays(), view(ends), air, {gases, gas},
                         step, out);
  return found;
}

} // namespace

void init_march(Module module) {
  using namespace py::literals;
  Class<Bricks, std::shared_ptr<Bricks>>(module, "Bricks")
      .def(py::init(&make_bricks), "density"_a, "fresh"_a, "sun"_a, "sky"_a, "glow"_a,
           "voxel_size"_a, "origin"_a, "edge"_a = py::none())
      .def_property_readonly("shape", &Bricks::shape)
      .def_property_readonly("used", &Bricks::used)
      .def_property_readonly("bytes", &Bricks::bytes);
  Class<HotGasArrays, std::shared_ptr<HotGasArrays>>(module, "HotGas")
      .def(py::init<const py::object&, const py::object&, const std::array<double, 2>&, double>(),
           "excess"_a, "heights"_a, "first"_a, "spacing"_a);
  Class<Illumination>(module, "Illumination")
      .def(py::init([](float density, const Colour& fresh, const Colour& old, const Colour& sun,
                       const Colour& sky, const Vector& sun_direction, double anisotropy,
                       const std::array<float, 2>& multiple_scattering, const Colour& glow,
                       float thin, const Colour& air, const Colour& horizon,
                       const std::array<float, 2>& thick_haze, const std::array<double, 2>& haze,
                       const std::array<double, 2>& haze_height) {
             return Illumination{density,    fresh,         old,        sun,
                                 sky,        sun_direction, anisotropy, multiple_scattering,
                                 glow,       thin,          air,        horizon,
                                 thick_haze, haze,          haze_height};
           }),
           py::kw_only(), "density"_a, "fresh"_a, "old"_a, "sun"_a, "sky"_a, "sun_direction"_a,
           "anisotropy"_a, "multiple_scattering"_a, "glow"_a, "thin"_a, "air"_a, "horizon"_a,
           "thick_haze"_a, "haze"_a, "haze_height"_a);
  const volume::MarchSettings defaults;
  module.def("march", &march, "layers"_a, "origins"_a, "directions"_a, "distances"_a, "light"_a,
             "step"_a = defaults.step, "min_transmittance"_a = defaults.min_transmittance,
             "flames"_a = nullptr, "pixel"_a = defaults.pixel, "parts"_a = defaults.parts);
  module.def("march_infrared", &march_infrared, "layers"_a, "origins"_a, "directions"_a,
             "distances"_a, py::kw_only(), "kelvin"_a, "elevation"_a, "corner"_a, "spacing"_a,
             "lapse"_a, "radiance"_a, "coldest"_a, "kelvin_step"_a, "absorption"_a, "step"_a = 4.0,
             "flames"_a = nullptr, "hot"_a = std::vector<std::shared_ptr<HotGasArrays>>{},
             "gas"_a = 0.0);
  module.def("flame_distance", &flame_distance, "flames"_a, "origins"_a, "directions"_a,
             "farthest"_a);
  module.def("optical_depth", &optical_depth, "layers"_a, "origins"_a, "directions"_a,
             "distances"_a, "step"_a = 2.0, "max_depth"_a = 20.0);
  module.def("opaque_distance", &opaque_distance, "layers"_a, "origins"_a, "directions"_a, "step"_a,
             "depth"_a);
}

} // namespace firetwin::bindings
