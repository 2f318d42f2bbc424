#include "arrays.hpp"
#include "bindings.hpp"
#include "tiles/content_type.hpp"
#include "tiles/decode.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace firetwin::bindings {
namespace py = pybind11;
namespace {

using tiles::Image;
using tiles::Material;
using tiles::Range;
using tiles::Tile;

/// A vertex or triangle array of a tile as rows of n.
template <auto member, py::ssize_t n> py::object rows(const py::object& self) {
  const auto& values = self.cast<const Tile&>().*member;
  using T = typename std::decay_t<decltype(values)>::value_type;
  return lend<T>(values, {length(values.size()) / n, n}, self);
}

tiles::Bytes bytes_of(const py::bytes& bytes) {
  char* data = nullptr;
  py::ssize_t size = 0;
  if (PyBytes_AsStringAndSize(bytes.ptr(), &data, &size) != 0) {
    throw py::error_already_set();
  }
  return {reinterpret_cast<const std::uint8_t*>(data), static_cast<std::size_t>(size)};
}

/// Resources; keeps their bytes alive.
struct HeldResources {
  explicit HeldResources(const std::optional<py::dict>& given) {
    for (const auto& [uri, bytes] : given.value_or(py::dict())) {
      if (!py::isinstance<py::bytes>(bytes)) {
        wrong("resources", "must hold bytes");
      }
      held.append(bytes);
      views[uri.cast<std::string>()] = bytes_of(py::reinterpret_borrow<py::bytes>(bytes));
    }
  }
  py::list held;
  tiles::Resources views;
};

tiles::Matrix to_matrix(const py::object& object, const char* name) {
  const auto array = to_array<double>(object, name, {4, 4});
  tiles::Matrix matrix{};
  std::copy_n(array.data(), matrix.size(), matrix.begin());
  return matrix;
}

tiles::UpAxis to_axis(const std::string& name) {
  if (name == "X" || name == "x") {
    return tiles::UpAxis::x;
  }
  if (name == "Y" || name == "y") {
    return tiles::UpAxis::y;
  }
  if (name == "Z" || name == "z") {
    return tiles::UpAxis::z;
  }
  wrong("up_axis", "must be X, Y or Z");
}

std::shared_ptr<Tile> decode(const py::bytes& content, const py::object& matrix,
                             const std::string& name, const std::optional<py::dict>& resources,
                             const py::object& earth_matrix, const std::string& up_axis) {
  tiles::DecodeOptions options;
  options.to_scene = to_matrix(matrix, "matrix");
  options.to_earth =
      earth_matrix.is_none() ? tiles::identity : to_matrix(earth_matrix, "earth_matrix");
  options.up_axis = to_axis(up_axis);
  const HeldResources held(resources);
  const tiles::Bytes bytes = bytes_of(content);
  const py::gil_scoped_release release;
  return std::make_shared<Tile>(tiles::decode(bytes, name, held.views, options));
}

std::vector<std::string> list_missing_resources(const py::bytes& content, const std::string& name,
                                                const std::optional<py::dict>& resources) {
  const HeldResources held(resources);
  return tiles::list_missing_resources(bytes_of(content), name, held.views);
}

std::string content_type(const py::bytes& content, const std::string& name) {
  return tiles::name_of(tiles::detect_content_type(bytes_of(content), name));
}

void bind_parts(const Module& module) {
  Class<Image>(module, "Image")
      .def_readonly("kind", &Image::kind)
      .def_readonly("width", &Image::width)
      .def_readonly("height", &Image::height)
      .def_property_readonly("data",
                             [](const Image& image) {
                               return py::bytes(reinterpret_cast<const char*>(image.data.data()),
                                                image.data.size());
                             })
      .def_readonly("uri", &Image::uri);
  Class<Material>(module, "Material")
      .def_readonly("colour", &Material::colour)
      .def_readonly("image", &Material::image)
      .def_readonly("wrap_u", &Material::wrap_u)
      .def_readonly("wrap_v", &Material::wrap_v)
      .def_readonly("alpha_mode", &Material::alpha_mode)
      .def_readonly("alpha_cutoff", &Material::alpha_cutoff)
      .def_readonly("double_sided", &Material::double_sided);
  Class<Range>(module, "Range")
      .def_readonly("material", &Range::material)
      .def_readonly("first_vertex", &Range::first_vertex)
      .def_readonly("vertices", &Range::vertices)
      .def_readonly("first_triangle", &Range::first_triangle)
      .def_readonly("triangles", &Range::triangles)
      .def_readonly("points", &Range::points)
      .def_readonly("has_normals", &Range::has_normals);
}

void bind_tile(const Module& module) {
  Class<Tile, std::shared_ptr<Tile>>(module, "Tile")
      .def_property_readonly("origin",
                             [](const py::object& self) {
                               return lend<double>(self.cast<const Tile&>().origin, {3}, self);
                             })
      .def_property_readonly("position", &rows<&Tile::position, 3>)
      .def_property_readonly("normal", &rows<&Tile::normal, 3>)
      .def_property_readonly("uv", &rows<&Tile::uv, 2>)
      .def_property_readonly("colour", &rows<&Tile::colour, 4>)
      .def_property_readonly("triangle", &rows<&Tile::triangle, 3>)
      .def_readonly("ranges", &Tile::ranges)
      .def_readonly("materials", &Tile::materials)
      .def_readonly("images", &Tile::images)
      .def_property_readonly("copyright", [](const Tile& tile) { return readable(tile.copyright); })
      .def_readonly("spacing", &Tile::spacing)
      .def_readonly("not_finite", &Tile::not_finite)
      .def_readonly("lines", &Tile::lines);
}

} // namespace

void init_tiles(Module module) {
  bind_parts(module);
  bind_tile(module);
  module.def("decode", &decode, py::arg("content"), py::arg("matrix"), py::arg("name"),
             py::arg("resources") = py::none(), py::arg("earth_matrix") = py::none(),
             py::arg("up_axis") = "Y");
  module.def("list_missing_resources", &list_missing_resources, py::arg("content"), py::arg("name"),
             py::arg("resources") = py::none());
  module.def("content_type", &content_type, py::arg("content"), py::arg("name"));
}

} // namespace firetwin::bindings
