#include "terrain/mesh.hpp"

#include "terrain/points.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace firetwin::terrain {
namespace {

constexpr std::int32_t none = -1;
/// Barycentric tolerance for points outside a triangle: rows of the grid are curved, so its rim is
/// not straight (0.2 % over 50 km at 39 degrees north).
constexpr double edge_slack = 0.005;

struct Vertex {
  std::int32_t x, y; ///< units of the lattice
  Vector place;      ///< m
};

/// Right triangle, counter-clockwise: the apex and the ends of the hypotenuse, and the neighbours
/// across the hypotenuse, the left leg and the right leg.
struct Triangle {
  std::int32_t apex, left, right;
  std::int32_t base, beside_left, beside_right;
};

class Refinement {
public:
  Refinement(const MeshInput& input, const Points& points)
      : input_(input), points_(points), waves_(points.waves()) {
    std::int32_t side = std::int32_t{1} << points.depth();
    while (side < std::max(points.width(), points.height())) {
      side *= 2;
    }
    vertices_ = {{0, 0, {}}, {side, 0, {}}, {side, side, {}}, {0, side, {}}};
    for (Vertex& vertex : vertices_) {
      vertex.place = place(vertex.x, vertex.y);
    }
    triangles_ = {{1, 2, 0, 1, none, none}, {3, 0, 2, 0, none, none}};
  }

  /// Bisects triangles until all meet the tolerance. Each round tests its triangles in parallel,
  /// then bisects them one by one, which gives the triangles of the next round.
  void run() {
    std::size_t first = 0;
    std::vector<std::int32_t> open{0, 1};
    std::vector<char> wrong;
    while (!open.empty()) {
      first = triangles_.size();
      wrong.resize(open.size());
      tbb::parallel_for(std::size_t{0}, open.size(),
                        [&](std::size_t i) { wrong[i] = must_halve(triangle(open[i])); });
      const std::vector<Triangle> before = seen_of(open);
      changed_.clear();
      for (std::size_t i = 0; i < open.size(); ++i) {
        if (wrong[i] && same(triangle(open[i]), before[i])) {
          halve(open[i]);
        }
      }
      open.assign(changed_.begin(), changed_.end());
      for (std::size_t i = first; i < triangles_.size(); ++i) {
        open.push_back(static_cast<std::int32_t>(i));
      }
      std::sort(open.begin(), open.end());
      open.erase(std::unique(open.begin(), open.end()), open.end());
    }
  }

  Mesh result() const {
    Mesh mesh;
    std::vector<std::int32_t> number(vertices_.size(), none);
    const double unit = static_cast<double>(std::int32_t{1} << points_.depth());
    for (const Triangle& t : triangles_) {
      if (outside(t)) {
        continue;
      }
      for (const std::int32_t corner : {t.apex, t.left, t.right}) {
        std::int32_t& known = number[index(corner)];
        if (known == none) {
          known = static_cast<std::int32_t>(mesh.row.size());
          mesh.row.push_back(vertex(corner).y / unit);
          mesh.column.push_back(vertex(corner).x / unit);
        }
        mesh.triangle.push_back(known);
      }
    }
    return mesh;
  }

private:
  static std::size_t index(std::int32_t number) { return static_cast<std::size_t>(number); }
  const Vertex& vertex(std::int32_t number) const { return vertices_[index(number)]; }
  Triangle& triangle(std::int32_t number) { return triangles_[index(number)]; }

  static bool same(const Triangle& a, const Triangle& b) {
    return a.apex == b.apex && a.left == b.left && a.right == b.right;
  }
  std::vector<Triangle> seen_of(const std::vector<std::int32_t>& open) {
    std::vector<Triangle> found;
    found.reserve(open.size());
    for (const std::int32_t each : open) {
      found.push_back(triangle(each));
    }
    return found;
  }

  Vector place(std::int32_t x, std::int32_t y) {
    return x > points_.width() || y > points_.height() ? Vector{} : points_.at(x, y, waves_);
  }

  struct Box {
    std::int32_t left, right, low, high;
  };
  Box box(const Triangle& t) const {
    const Vertex &a = vertex(t.apex), &b = vertex(t.left), &c = vertex(t.right);
    return {std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}),
            std::max({a.y, b.y, c.y})};
  }
  bool outside(const Triangle& t) const {
    const Box around = box(t);
    return around.left >= points_.width() || around.low >= points_.height();
  }

  /// True if the midpoint of the hypotenuse is on the lattice.
  bool can_halve(const Triangle& t) const {
    const Vertex &b = vertex(t.left), &c = vertex(t.right);
    return (((b.x + c.x) | (b.y + c.y)) & 1) == 0;
  }

  bool must_halve(const Triangle& t) const {
    const Box around = box(t);
    if (!can_halve(t) || around.left >= points_.width() || around.low >= points_.height()) {
      return false;
    }
    return around.right > points_.width() || around.high > points_.height() || too_wide(around) ||
           exceeds_tolerance(t, around);
  }

  /// True if a triangle overlaps the margin and exceeds max_span.
  bool too_wide(const Box& around) const {
    const auto margin = static_cast<std::int32_t>(input_.margin << points_.depth());
    const auto max_span = static_cast<std::int32_t>(input_.max_span << points_.depth());
    const bool reaches = around.left < margin || around.low < margin ||
                         around.right > points_.width() - margin ||
                         around.high > points_.height() - margin;
    return reaches && std::max(around.right - around.left, around.high - around.low) > max_span;
  }

  /// True if the vertical error of a triangle exceeds the tolerance of a point.
  bool exceeds_tolerance(const Triangle& t, const Box& around) const {
    const Vector &a = vertex(t.apex).place, &b = vertex(t.left).place, &c = vertex(t.right).place;
    const double bx = b[0] - a[0], by = b[1] - a[1], cx = c[0] - a[0], cy = c[1] - a[1];
    const double area = bx * cy - by * cx;
    const double rise_b = (b[2] - a[2]) / area, rise_c = (c[2] - a[2]) / area;
    const double least = -edge_slack * area;
    const auto fits = [&](const Vector& p, double tolerance) {
      const double x = p[0] - a[0], y = p[1] - a[1];
      const double part_b = x * cy - y * cx, part_c = bx * y - by * x;
      return part_b < least || part_c < least || area - part_b - part_c < least ||
             std::abs(a[2] + part_b * rise_b + part_c * rise_c - p[2]) <= tolerance;
    };
    return !points_.each(around.left, around.right, around.low, around.high, fits);
  }

  /// Bisects a triangle and its neighbour across the hypotenuse, after bisecting the neighbour to
  /// equal size if necessary.
  void halve(std::int32_t number) {
    while (triangle(number).base != none && triangle(triangle(number).base).base != number) {
      halve(triangle(number).base);
    }
    const Triangle old = triangle(number);
    const Vertex &b = vertex(old.left), &c = vertex(old.right);
    const auto middle = static_cast<std::int32_t>(vertices_.size());
    const std::int32_t x = (b.x + c.x) / 2, y = (b.y + c.y) / 2;
    vertices_.push_back({x, y, place(x, y)});
    const std::int32_t second = cut(number, middle);
    if (old.base != none) {
      const std::int32_t other = cut(old.base, middle);
      triangle(number).beside_right = other; // the halves of both that share half of the hypotenuse
      triangle(other).beside_left = number;
      triangle(second).beside_left = old.base;
      triangle(old.base).beside_right = second;
    }
  }

  /// Replaces a triangle by its left half and returns the number of the right half.
  std::int32_t cut(std::int32_t number, std::int32_t middle) {
    const Triangle old = triangle(number);
    const auto second = static_cast<std::int32_t>(triangles_.size());
    triangle(number) = {middle, old.apex, old.left, old.beside_left, second, none};
    triangles_.push_back({middle, old.right, old.apex, old.beside_right, none, number});
    if (old.beside_right != none) {
      Triangle& beyond = triangle(old.beside_right);
      for (std::int32_t* side : {&beyond.base, &beyond.beside_left, &beyond.beside_right}) {
        if (*side == number) {
          *side = second;
          break;
        }
      }
    }
    changed_.push_back(number);
    return second;
  }

  const MeshInput& input_;
  const Points& points_;
  std::vector<Wave> waves_;
  std::vector<Vertex> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<std::int32_t> changed_; ///< triangles bisected in this round
};

} // namespace

Mesh mesh(const MeshInput& input, const NearDetail& detail) {
  const Points points(input, detail);
  Refinement refinement(input, points);
  refinement.run();
  return refinement.result();
}

} // namespace firetwin::terrain
