#include "arrays.hpp"
#include "base/noise.hpp"
#include "bindings.hpp"
#include "terrain/interpolate.hpp"
#include "terrain/mesh.hpp"
#include "terrain/surface.hpp"

#include <pybind11/stl.h>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using terrain::Surface;

template <class T> std::vector<T> values(const Array<T>& array) {
  return {array.data(), array.data() + array.size()};
}

/// First row and column, points per cell, offsets and shares.
using Known = std::tuple<std::size_t, std::size_t, std::size_t, py::object, py::object>;

terrain::Patch patch(const Known& known) {
  const auto& [row, column, parts, offset, share] = known;
  const auto offsets = to_array<float>(offset, "offset", {-1, -1});
  const auto shares = to_array<float>(share, "share", {offsets.shape(0), offsets.shape(1)});
  return {row,
          column,
          parts,
          static_cast<std::size_t>(offsets.shape(0)),
          static_cast<std::size_t>(offsets.shape(1)),
          values(offsets),
          values(shares)};
}

std::shared_ptr<Surface> surface(const py::object& elevation, const py::object& steep,
                                 const py::object& dry, std::array<double, 2> cell,
                                 const std::vector<std::array<double, 2>>& octaves, double strength,
                                 double level, double sharp, double mean, std::int64_t seed,
                                 const std::optional<Known>& known) {
  const auto height = to_array<double>(elevation, "elevation", {-1, -1});
  const auto slope = to_array<float>(steep, "steep", {height.shape(0), height.shape(1)});
  const auto land = to_array<float>(dry, "dry", {height.shape(0), height.shape(1)});
  terrain::Relief relief{{}, strength, level, sharp, mean, seed};
  for (const auto& [size, weight] : octaves) {
    relief.octaves.push_back({size, weight});
  }
  terrain::Patch fine = known ? patch(*known) : terrain::Patch{};
  const py::gil_scoped_release release;
  return std::make_shared<Surface>(
      Grid<double>{static_cast<std::size_t>(height.shape(0)),
                   static_cast<std::size_t>(height.shape(1)), values(height)},
      values(slope), values(land), cell[0], cell[1], std::move(relief), std::move(fine));
}

Array<double> detail(const Surface& ground, const py::object& row, const py::object& column) {
  const auto rows = to_array<double>(row, "row", {-1});
  const auto columns = to_array<double>(column, "column", {rows.size()});
  auto result = new_array<double>({rows.size()});
  const auto i = view(rows), j = view(columns);
  const auto out = writable(result);
  const py::gil_scoped_release release;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, out.size(), 1024), [&](const auto& range) {
    std::vector<terrain::Wave> waves = ground.waves();
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      out[k] = ground.detail(i[k], j[k], waves);
    }
  });
  return result;
}

Array<double> perlin(const py::object& x, const py::object& y, std::int64_t seed) {
  const auto across = to_array<double>(x, "x", {-1});
  const auto up = to_array<double>(y, "y", {across.size()});
  auto result = new_array<double>({across.size()});
  const auto i = view(across), j = view(up);
  const auto out = writable(result);
  const py::gil_scoped_release release;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, out.size(), 4096), [&](const auto& range) {
    terrain::Wave wave(seed);
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      out[k] = wave(i[k], j[k]);
    }
  });
  return result;
}

/// Interpolates a field (ny, nx) or (ny, nx, bands) bilinearly at rows and columns, which
/// broadcast.
Array<double> bilinear(const py::object& field, const py::object& row, const py::object& column) {
  const auto together =
      py::module_::import("numpy").attr("broadcast_arrays")(row, column).cast<py::sequence>();
  const auto rows = to_array<double>(together[0], "row");
  const auto columns = to_array<double>(together[1], "column");
  const py::array any = py::array::ensure(field);
  const bool single = any && any.dtype().is(py::dtype::of<float>());
  const auto values = [&](const auto& array) {
    if ((array.ndim() != 2 && array.ndim() != 3) || array.size() == 0) {
      wrong("field", "must have at least one row and one column, not shape " + shape_text(array));
    }
    std::vector<py::ssize_t> shape(rows.shape(), rows.shape() + rows.ndim());
    if (array.ndim() == 3) {
      shape.push_back(array.shape(2));
    }
    auto result = new_array<double>(shape);
    const auto out = writable(result);
    const auto i = view(rows), j = view(columns);
    const terrain::Field known{array.data(), std::int64_t{array.shape(0)},
                               std::int64_t{array.shape(1)},
                               std::int64_t{array.ndim() == 3 ? array.shape(2) : 1}};
    const py::gil_scoped_release release;
    terrain::interpolate(known, i, j, out);
    return result;
  };
  return single ? values(to_array<float>(field, "field"))
                : values(to_array<double>(field, "field"));
}

/// Random numbers 0..1 of integers x and y, which broadcast, and the seed.
Array<double> uniform(const py::object& x, const py::object& y, std::int64_t seed) {
  const auto together =
      py::module_::import("numpy").attr("broadcast_arrays")(x, y).cast<py::sequence>();
  const auto across = to_array<std::int64_t>(together[0], "x");
  const auto up = to_array<std::int64_t>(together[1], "y");
  auto result = new_array<double>({across.shape(), across.shape() + across.ndim()});
  const auto i = view(across), j = view(up);
  const auto out = writable(result);
  const py::gil_scoped_release release;
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k] = static_cast<double>(lattice_hash(i[k], j[k], seed)) * 0x1p-32;
  }
  return result;
}

/// 3-D gradient noise at points (n, 3), with Jenkins's hash.
Array<double> perlin_in_space(const py::object& place) {
  const auto places = to_array<double>(place, "place", {-1, 3});
  auto result = new_array<double>({places.shape(0)});
  const auto p = view(places);
  const auto out = writable(result);
  const py::gil_scoped_release release;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, out.size(), 4096), [&](const auto& range) {
    for (std::size_t n = range.begin(); n < range.end(); ++n) {
      std::array<std::uint32_t, 3> low{};
      std::array<double, 3> off{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double whole = std::floor(p[3 * n + axis]);
        low[axis] = static_cast<std::uint32_t>(static_cast<std::int64_t>(whole));
        off[axis] = p[3 * n + axis] - whole;
      }
      const auto rise = [&](std::uint32_t k, std::uint32_t j, std::uint32_t i) {
        return cube_rise(jenkins_hash(low[0] + i, low[1] + j, low[2] + k), off[0] - i, off[1] - j,
                         off[2] - k);
      };
      out[n] = gradient_noise(rise, off[2], off[1], off[0]);
    }
  });
  return result;
}

using Made = std::tuple<Array<double>, Array<double>, Array<std::int32_t>>;

Made mesh(const py::object& place, const py::object& tolerance, const py::object& subdivision,
          const std::shared_ptr<Surface>& ground, const py::object& camera, double radius,
          std::size_t margin, std::size_t max_span) {
  const auto places = to_array<float>(place, "place", {-1, -1, 3});
  const auto errors = to_array<float>(tolerance, "tolerance", {places.shape(0), places.shape(1)});
  Array<double> eyes;
  if (!camera.is_none()) {
    eyes = to_array<double>(camera, "camera", {-1, 3});
  }
  Array<std::uint8_t> levels;
  if (!subdivision.is_none()) {
    levels = to_array<std::uint8_t>(subdivision, "subdivision",
                                    {places.shape(0) - 1, places.shape(1) - 1});
  }
  terrain::Mesh made;
  {
    const py::gil_scoped_release release;
    made = terrain::mesh({static_cast<std::size_t>(places.shape(0)),
                          static_cast<std::size_t>(places.shape(1)), view(places), view(errors),
                          view(levels), margin, max_span},
                         {ground.get(), view(eyes), radius});
  }
  const auto vertices = length(made.row.size()), triangles = length(made.triangle.size() / 3);
  return {give(std::move(made.row), {vertices}), give(std::move(made.column), {vertices}),
          give(std::move(made.triangle), {triangles, 3})};
}

} // namespace

void init_terrain(Module module) {
  module.def("perlin", &perlin, py::arg("x"), py::arg("y"), py::arg("seed"));
  module.def("perlin_in_space", &perlin_in_space, py::arg("place"));
  module.def("uniform", &uniform, py::arg("x"), py::arg("y"), py::arg("seed"));
  module.def("bilinear", &bilinear, py::arg("field"), py::arg("row"), py::arg("column"));
  Class<Surface, std::shared_ptr<Surface>>(module, "Surface")
      .def(py::init(&surface), py::arg("elevation"), py::arg("steep"), py::arg("dry"),
           py::arg("cell"), py::arg("octaves"), py::arg("strength"), py::arg("level"),
           py::arg("sharp"), py::arg("mean"), py::arg("seed"), py::arg("patch") = py::none())
      .def("detail", &detail, py::arg("row"), py::arg("column"));
  module.def("mesh", &mesh, py::arg("place"), py::arg("tolerance"),
             py::arg("subdivision") = py::none(), py::arg("surface") = py::none(),
             py::arg("camera") = py::none(), py::arg("radius") = 0.0, py::arg("margin") = 0,
             py::arg("max_span") = 4);
}

} // namespace firetwin::bindings
