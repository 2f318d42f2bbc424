#include "arrays.hpp"
#include "base/sparse_smoke.hpp"
#include "bindings.hpp"
#include "placed.hpp"
#include "volume/bricks.hpp"
#include "volume/lit_smoke.hpp"

#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <optional>
#include <utility>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using volume::Bricks;
using volume::dim_glow;
using volume::LightDepths;
using volume::LitSmoke;
using volume::VisibleShare;

std::shared_ptr<LitSmoke> make_lit(std::shared_ptr<SparseSmoke> smoke, const Vector& direction,
                                   double sun_factor, double sky_factor,
                                   const std::shared_ptr<LightDepths>& beyond) {
  const py::gil_scoped_release release;
  return std::make_shared<LitSmoke>(std::move(smoke), direction, beyond.get(),
                                    std::array{sun_factor, sky_factor});
}

/// Returns the optical depths to the sun as a view that `self` keeps alive.
Array<float> sun_depths(const py::object& self) {
  const auto& found = self.cast<const LightDepths&>().sun;
  const auto [nx, ny, nz] = found.shape;
  return lend<float>(found.values, {nx, ny, nz}, self);
}

/// Returns the optical depths of smoke; Python never changes them.
std::shared_ptr<LightDepths> depths(const LitSmoke& lit) {
  return std::const_pointer_cast<LightDepths>(lit.depths());
}

Array<double> share_of(const LitSmoke& lit, const py::object& share) {
  const auto& shape = lit.smoke().shape();
  return to_array<double>(share, "share", {shape[0], shape[1]});
}

std::shared_ptr<Bricks> make_bricks(const LitSmoke& lit, const py::object& share,
                                    float min_extinction) {
  const auto shares = share_of(lit, share);
  const py::gil_scoped_release release;
  return std::make_shared<Bricks>(lit, VisibleShare{view(shares), min_extinction});
}

/// Returns all fields of smoke and its light by name, as dense arrays.
py::dict grids(const LitSmoke& lit, const py::object& share, float min_extinction) {
  const auto shares = share_of(lit, share);
  const SparseSmoke& smoke = lit.smoke();
  const auto& shape = smoke.shape();
  py::dict found;
  const auto add = [&](const char* name) {
    auto array = zeros({shape[0], shape[1], shape[2]});
    found[name] = array;
    return writable(array);
  };
  const auto density = add("density"), fresh = add("fresh"), sun = add("sun"), sky = add("sky");
  const auto glow = smoke.glows() ? add("glow") : std::span<float>{};
  const py::gil_scoped_release release;
  const VisibleShare visible{view(shares), min_extinction};
  smoke.spread(SparseSmoke::density, density,
               [&](float all, std::size_t column) { return visible.density(all, column); });
  smoke.spread(SparseSmoke::fresh, fresh);
  lit.write_dense(sun, sky);
  if (smoke.glows()) {
    smoke.spread(SparseSmoke::glow, glow);
  }
  return found;
}

py::tuple smoke_light(const py::object& extinction, double voxel_size, const Vector& direction,
                      double sun_factor, double sky_factor, const Vector& origin,
                      const std::shared_ptr<LightDepths>& beyond) {
  const auto dense = to_array<float>(extinction, "extinction", {-1, -1, -1});
  const std::vector<py::ssize_t> shape{dense.shape(0), dense.shape(1), dense.shape(2)};
  auto smoke = std::make_shared<SparseSmoke>(SparseSmoke::Place{shape[0], shape[1], shape[2]},
                                             voxel_size, origin, false);
  smoke->keep_all(view(dense));
  const auto found = make_lit(smoke, direction, sun_factor, sky_factor, beyond);
  auto sun = zeros(shape), sky = zeros(shape);
  found->write_dense(writable(sun), writable(sky));
  return py::make_tuple(sun, sky, depths(*found));
}

} // namespace

void init_smoke(Module module) {
  using namespace py::literals;
  Class<SparseSmoke, std::shared_ptr<SparseSmoke>>(module, "SparseSmoke")
      .def_property_readonly("voxel_size", &SparseSmoke::voxel)
      .def_property_readonly("origin", &SparseSmoke::origin)
      .def_property_readonly("shape", &SparseSmoke::shape)
      .def_property_readonly("used", &SparseSmoke::used)
      .def("dim_glow", &dim_glow, "part"_a, py::call_guard<py::gil_scoped_release>());
  Class<LightDepths, std::shared_ptr<LightDepths>>(module, "LightDepths")
      .def_property_readonly("sun", &sun_depths);
  Class<LitSmoke, std::shared_ptr<LitSmoke>>(module, "LitSmoke")
      .def(py::init(&make_lit), "smoke"_a, "direction"_a, "sun_factor"_a, "sky_factor"_a,
           "beyond"_a = py::none())
      .def_property_readonly("depths", &depths)
      .def("bricks", &make_bricks, "share"_a, "min_extinction"_a)
      .def("grids", &grids, "share"_a, "min_extinction"_a);
  module.def("smoke_light", &smoke_light, "extinction"_a, "voxel_size"_a, "direction"_a,
             "sun_factor"_a, "sky_factor"_a, "origin"_a = Vector{}, "beyond"_a = py::none());
}

} // namespace firetwin::bindings
