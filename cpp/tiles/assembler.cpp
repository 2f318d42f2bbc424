#include "tiles/assembler.hpp"

#include "tiles/json.hpp"
#include "tiles/limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace firetwin::tiles {
namespace {

Vector vector_at(const std::vector<float>& values, std::size_t i) {
  return {static_cast<double>(values[3 * i]), static_cast<double>(values[3 * i + 1]),
          static_cast<double>(values[3 * i + 2])};
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first == std::string_view::npos
             ? std::string_view()
             : text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// Unit vector; (0, 0, 1) for a vector of length 0.
Vector unit(const Vector& v) {
  const double length = std::sqrt(dot(v, v));
  if (!(length > 0.0) || !std::isfinite(length)) {
    return {0.0, 0.0, 1.0};
  }
  return {v[0] / length, v[1] / length, v[2] / length};
}

/// Largest scale factor of the matrix along the three axes.
double stretch(const Matrix& m) {
  double square = 0.0;
  for (std::size_t column = 0; column < 3; ++column) {
    const Vector axis = {m[column], m[4 + column], m[8 + column]};
    square = std::max(square, dot(axis, axis));
  }
  return std::sqrt(square);
}

void push(std::vector<float>& values, const Vector& v) {
  for (const double component : v) {
    values.push_back(static_cast<float>(component));
  }
}

} // namespace

int Assembler::add_image(Image image) {
  tile_.images.push_back(std::move(image));
  return static_cast<int>(tile_.images.size()) - 1;
}

int Assembler::add_material(Material material) {
  tile_.materials.push_back(std::move(material));
  return static_cast<int>(tile_.materials.size()) - 1;
}

void Assembler::add_copyright(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(';'), text.size());
    const std::string notice(trimmed(text.substr(0, end)));
    if (!notice.empty() && std::find(notices_.begin(), notices_.end(), notice) == notices_.end()) {
      notices_.push_back(notice);
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

void Assembler::reserve_bytes(std::size_t bytes) {
  if (bytes > max_decoded_bytes || bytes_ > max_decoded_bytes - bytes) {
    refuse(name_, "exceeds 1 GB when decoded");
  }
  bytes_ += bytes;
}

void Assembler::add_draw(std::shared_ptr<const Primitive> primitive, const Matrix& to_scene) {
  if (++instances_ > max_instances) {
    refuse(name_, "has more than " + std::to_string(max_instances) + " instances");
  }
  if (determinant(to_scene) == 0.0) {
    return;
  }
  vertices_ += primitive->vertices();
  if (vertices_ > max_vertices) {
    refuse(name_, "has more than " + std::to_string(max_vertices) + " vertices");
  }
  draws_.push_back({std::move(primitive), to_scene});
}

Assembler::Bounds Assembler::bounds(const Draw& draw) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Bounds found{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}, 0.0};
  float farthest = 0.0F;
  for (std::size_t i = 0; i < draw.primitive->vertices(); ++i) {
    const Vector place = transform_point(draw.to_scene, vector_at(draw.primitive->position, i));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      farthest = std::max(farthest, std::abs(draw.primitive->position[3 * i + axis]));
      if (!(std::abs(place[axis]) <= max_vertex_distance)) { // true for NaN
        found.low[axis] = found.high[axis] = infinity;
        return found;
      }
      found.low[axis] = std::min(found.low[axis], place[axis]);
      found.high[axis] = std::max(found.high[axis], place[axis]);
    }
  }
  const float next = std::nextafter(farthest, std::numeric_limits<float>::infinity());
  found.spacing = static_cast<double>(next - farthest) * stretch(draw.to_scene);
  return found;
}

/// Sets the origin to the centre of all draws within max_vertex_distance and drops the others.
void Assembler::choose_origin() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Bounds all{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}, 0.0};
  std::erase_if(draws_, [&](const Draw& draw) {
    const Bounds own = bounds(draw);
    const bool far =
        std::any_of(own.high.begin(), own.high.end(), [](double v) { return v == infinity; });
    for (std::size_t axis = 0; axis < 3 && !far; ++axis) {
      all.low[axis] = std::min(all.low[axis], own.low[axis]);
      all.high[axis] = std::max(all.high[axis], own.high[axis]);
    }
    tile_.spacing = far ? tile_.spacing : std::max(tile_.spacing, own.spacing);
    tile_.not_finite += far ? draw.primitive->vertices() : 0;
    return far;
  });
  for (std::size_t axis = 0; axis < 3 && all.low[0] <= all.high[0]; ++axis) {
    tile_.origin[axis] = std::round(0.5 * (all.low[axis] + all.high[axis]));
  }
}

void Assembler::append_vertices(const Draw& draw, bool coloured) {
  const Primitive& from = *draw.primitive;
  const std::size_t n = from.vertices();
  const Matrix normals = for_normals(draw.to_scene);
  for (std::size_t i = 0; i < n; ++i) {
    push(tile_.position,
         minus(transform_point(draw.to_scene, vector_at(from.position, i)), tile_.origin));
    push(tile_.normal, from.normal.empty()
                           ? Vector{}
                           : unit(transform_direction(normals, vector_at(from.normal, i))));
  }
  if (from.uv.empty()) {
    tile_.uv.resize(tile_.uv.size() + 2 * n);
  } else {
    tile_.uv.insert(tile_.uv.end(), from.uv.begin(), from.uv.end());
  }
  if (coloured && from.colour.empty()) {
    tile_.colour.resize(tile_.colour.size() + 4 * n, 1.0F);
  } else if (coloured) {
    tile_.colour.insert(tile_.colour.end(), from.colour.begin(), from.colour.end());
  }
}

void Assembler::append(const Draw& draw, bool coloured) {
  const Primitive& from = *draw.primitive;
  Range* range = tile_.ranges.empty() ? nullptr : &tile_.ranges.back();
  if (range == nullptr || range->material != from.material || range->points != from.points ||
      range->has_normals != from.has_normals) {
    range = &tile_.ranges.emplace_back();
    range->material = from.material;
    range->points = from.points;
    range->has_normals = from.has_normals;
    range->first_vertex = tile_.position.size() / 3;
    range->first_triangle = tile_.triangle.size() / 3;
  }
  const auto before = static_cast<std::uint32_t>(tile_.position.size() / 3);
  append_vertices(draw, coloured);
  const bool mirrored = determinant(draw.to_scene) < 0.0;
  for (std::size_t i = 0; i < from.triangle.size(); i += 3) {
    tile_.triangle.push_back(before + from.triangle[i]);
    tile_.triangle.push_back(before + from.triangle[mirrored ? i + 2 : i + 1]);
    tile_.triangle.push_back(before + from.triangle[mirrored ? i + 1 : i + 2]);
  }
  range->vertices += from.vertices();
  range->triangles += from.triangle.size() / 3;
}

Tile Assembler::finish() {
  choose_origin();
  std::size_t vertices = 0, indices = 0;
  bool coloured = false;
  for (const Draw& draw : draws_) {
    vertices += draw.primitive->vertices();
    indices += draw.primitive->triangle.size();
    coloured = coloured || !draw.primitive->colour.empty();
  }
  reserve_bytes(vertices * (coloured ? 48 : 32) + 4 * indices);
  const auto key = [](const Draw& draw) {
    const Primitive& p = *draw.primitive;
    return std::tuple(p.points, p.material, p.has_normals);
  };
  std::stable_sort(draws_.begin(), draws_.end(),
                   [&](const Draw& a, const Draw& b) { return key(a) < key(b); });
  tile_.position.reserve(3 * vertices);
  tile_.normal.reserve(3 * vertices);
  tile_.uv.reserve(2 * vertices);
  tile_.colour.reserve(coloured ? 4 * vertices : 0);
  tile_.triangle.reserve(indices);
  for (const Draw& draw : draws_) {
    append(draw, coloured);
  }
  for (const std::string& notice : notices_) {
    tile_.copyright += (tile_.copyright.empty() ? "" : "; ") + notice;
  }
  return std::move(tile_);
}

} // namespace firetwin::tiles
