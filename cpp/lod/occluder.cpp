#include "lod/occluder.hpp"

#include "base/check.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace firetwin::lod {
namespace {

constexpr double max_cells = 4.0e6;
constexpr double cells_per_quad = 4.0; ///< a higher resolution loses less at ridges
/// Fraction of a cell by which a quad is enlarged, for curvature between its nodes.
constexpr double bend = 0.01;
constexpr float none = -std::numeric_limits<float>::infinity();
constexpr float unset = std::numeric_limits<float>::infinity();

/// Largest float not above `value`.
float rounded_down(double value) {
  const auto near = static_cast<float>(value);
  return double{near} > value ? std::nextafter(near, none) : near;
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double length() const { return high - low; }
};

} // namespace

Occluder::Occluder(std::span<const double> node, std::size_t rows, std::size_t columns) {
  if (rows < 2 || columns < 2) {
    throw std::invalid_argument("position must have at least two rows and columns");
  }
  check_finite(node, "position");
  Range x, y;
  for (std::size_t i = 0; i < node.size(); i += 3) {
    x.add(node[i]);
    y.add(node[i + 1]);
  }
  const double area = x.length() * y.length();
  const double quads = static_cast<double>((rows - 1) * (columns - 1));
  cell_ = std::sqrt(area / std::min(cells_per_quad * quads, max_cells));
  if (!(cell_ > 0.0) || !(std::max(x.length(), y.length()) / cell_ < max_cells)) {
    throw std::invalid_argument("position must cover an area");
  }
  x_ = x.low, y_ = y.low;
  const auto count = [this](const Range& r) {
    return static_cast<long>(std::floor(r.length() / cell_)) + 1;
  };
  Blocks base{count(y), count(x), {}, {}};
  base.lowest.assign(static_cast<std::size_t>(base.rows * base.columns), unset);
  blocks_.push_back(std::move(base));
  for (std::size_t r = 0; r + 1 < rows; ++r) {
    for (std::size_t c = 0; c + 1 < columns; ++c) {
      const bool rim = r == 0 || c == 0 || r + 2 == rows || c + 2 == columns;
      add_quad(node, r * columns + c, columns, rim);
    }
  }
  for (float& low : blocks_[0].lowest) {
    low = low == unset ? none : low;
  }
  build_blocks();
}

/// Quads at the rim mark the end of the surface: cells that they overlap are not covered.
void Occluder::add_quad(std::span<const double> node, std::size_t corner, std::size_t columns,
                        bool rim) {
  Range x, y, z;
  for (const std::size_t i : {corner, corner + 1, corner + columns, corner + columns + 1}) {
    x.add(node[3 * i]);
    y.add(node[3 * i + 1]);
    z.add(node[3 * i + 2]);
  }
  Blocks& base = blocks_[0];
  const double more = bend * cell_;
  const Cells reached = cells(x.low - more, x.high + more, y.low - more, y.high + more);
  const float low = rim ? none : rounded_down(z.low);
  for (long r = std::max(reached.low, 0L); r <= std::min(reached.high, base.rows - 1); ++r) {
    for (long c = std::max(reached.left, 0L); c <= std::min(reached.right, base.columns - 1); ++c) {
      float& here = base.lowest[static_cast<std::size_t>(r * base.columns + c)];
      here = std::min(here, low);
    }
  }
}

void Occluder::build_blocks() {
  blocks_[0].highest = blocks_[0].lowest;
  while (blocks_.back().rows > 1 || blocks_.back().columns > 1) {
    const Blocks& fine = blocks_.back();
    Blocks coarse{(fine.rows + 1) / 2, (fine.columns + 1) / 2, {}, {}};
    const auto size = static_cast<std::size_t>(coarse.rows * coarse.columns);
    coarse.lowest.assign(size, unset);
    coarse.highest.assign(size, none);
    for (long r = 0; r < fine.rows; ++r) {
      for (long c = 0; c < fine.columns; ++c) {
        const auto from = static_cast<std::size_t>(r * fine.columns + c);
        const auto to = static_cast<std::size_t>(r / 2 * coarse.columns + c / 2);
        coarse.lowest[to] = std::min(coarse.lowest[to], fine.lowest[from]);
        coarse.highest[to] = std::max(coarse.highest[to], fine.highest[from]);
      }
    }
    blocks_.push_back(std::move(coarse));
  }
}

Occluder::Cells Occluder::cells(double left, double right, double low, double high) const {
  return {index(left - x_), index(right - x_), index(low - y_), index(high - y_)};
}

long Occluder::index(double from_corner) const {
  // Clamped to the grid's range, so that it fits a long; rounded down without a library call.
  const double held = std::min(std::max(from_corner / cell_, -2.0), 1e8);
  const auto whole = static_cast<long>(held);
  return whole - (held < static_cast<double>(whole));
}

template <class Visit> void Occluder::visit(Cells c, const Visit& visit) const {
  // The finest level on which at most 3 x 3 blocks cover the cells.
  const auto most = static_cast<unsigned long>(std::max(c.right - c.left, c.high - c.low));
  int k = std::max(static_cast<int>(std::bit_width(most)) - 2, 0);
  const auto wide = [&k](long first, long last) { return (last >> k) - (first >> k) > 2; };
  while (wide(c.left, c.right) || wide(c.low, c.high)) {
    ++k;
  }
  c = {c.left >> k, c.right >> k, c.low >> k, c.high >> k};
  const Blocks& blocks = blocks_[static_cast<std::size_t>(k)];
  for (long row = c.low; row <= c.high; ++row) {
    for (long column = c.left; column <= c.right; ++column) {
      visit(blocks, static_cast<std::size_t>(row * blocks.columns + column));
    }
  }
}

double Occluder::lowest(const BoundingSphere& sphere) const {
  const auto& [at, r] = sphere;
  const Cells c = cells(at[0] - r, at[0] + r, at[1] - r, at[1] + r);
  if (c.left < 0 || c.low < 0 || c.right >= blocks_[0].columns || c.high >= blocks_[0].rows) {
    return double{none};
  }
  float least = unset;
  visit(c, [&](const Blocks& blocks, std::size_t i) { least = std::min(least, blocks.lowest[i]); });
  return double{least};
}

double Occluder::highest(Cells c) const {
  c = {std::max(c.left, 0L), std::min(c.right, blocks_[0].columns - 1), std::max(c.low, 0L),
       std::min(c.high, blocks_[0].rows - 1)};
  if (c.left > c.right || c.low > c.high) {
    return double{none};
  }
  float most = none;
  visit(c, [&](const Blocks& blocks, std::size_t i) { most = std::max(most, blocks.highest[i]); });
  return double{most};
}

/// All straight lines between two spheres.
class Occluder::Lines {
public:
  Lines(const Occluder& occluder, const BoundingSphere& from, const BoundingSphere& to)
      : ground_(occluder), from_(from), way_(minus(to.centre, from.centre)),
        grows_(to.radius - from.radius), length_(std::sqrt(way_[0] * way_[0] + way_[1] * way_[1])) {
  }

  /// True if the ground is above all lines at the fraction t, and t is one of the tested fractions.
  bool blocked(double t) const { return ground_.is_below(at(t).sphere) && tried(t); }

  /// Tests all fractions; `where` receives the one that is blocked.
  bool blocked_anywhere(double& where) const { return blocked(0.0, 1.0, at(0.0), at(1.0), where); }

private:
  /// All lines at one fraction: a bounding sphere and the cell below its centre.
  struct Point {
    BoundingSphere sphere;
    long column, row;
    double top() const { return sphere.centre[2] + sphere.radius; }
  };

  /// Tests the fractions between `a` and `b` by bisection; the lines are at `from` and `to` there.
  bool blocked(double a, double b, const Point& from, const Point& to, double& where) const {
    if (!(ground_.highest(under(from, to)) > std::min(from.top(), to.top()))) {
      return false;
    }
    const double half = 0.5 * (a + b);
    const Point middle = at(half);
    if (ground_.highest(under(middle, middle)) > middle.top() && ground_.is_below(middle.sphere)) {
      where = half;
      return true;
    }
    if (is_short(a, b)) {
      return false;
    }
    return blocked(half, b, middle, to, where) || blocked(a, half, from, middle, where);
  }

  /// True if the interval from `a` to `b` is too short to be halved again.
  bool is_short(double a, double b) const {
    const double radius = from_.radius + 0.5 * (a + b) * grows_;
    return (b - a) * length_ <= std::max(0.5 * ground_.cell_, 0.5 * radius);
  }

  /// True if t is the midpoint of an interval of the bisection.
  bool tried(double t) const {
    double a = 0.0, b = 1.0;
    for (double half = 0.5; half != t; half = 0.5 * (a + b)) {
      if (is_short(a, b)) {
        return false;
      }
      (t < half ? b : a) = half;
    }
    return true;
  }

  Point at(double t) const {
    const BoundingSphere sphere{{from_.centre[0] + t * way_[0], from_.centre[1] + t * way_[1],
                                 from_.centre[2] + t * way_[2]},
                                from_.radius + t * grows_};
    return {sphere, ground_.index(sphere.centre[0] - ground_.x_),
            ground_.index(sphere.centre[1] - ground_.y_)};
  }
  /// Cells below the middle line between two points. If the ground in each of them is below the top
  /// of all lines, so is the lowest of all cells below the lines.
  static Cells under(const Point& a, const Point& b) {
    return {std::min(a.column, b.column), std::max(a.column, b.column), std::min(a.row, b.row),
            std::max(a.row, b.row)};
  }

  const Occluder& ground_;
  BoundingSphere from_;
  Vector way_;
  double grows_, length_;
};

bool Occluder::occludes(const BoundingSphere& camera, const BoundingSphere& target,
                        double& where) const {
  const Lines lines(*this, camera, target);
  return lines.blocked(where) || lines.blocked_anywhere(where);
}

bool Occluder::is_below(const BoundingSphere& sphere) const {
  return lowest(sphere) > sphere.centre[2] + sphere.radius;
}

} // namespace firetwin::lod
