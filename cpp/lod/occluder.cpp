#include "lod/occluder.hpp"

#include "base/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace firetwin::lod {
namespace {

constexpr double most_cells = 4.0e6;
constexpr double cells_per_quad = 4.0; ///< more lose less at the edges of ridges
/// Part of a cell by which a quad is taken to be wider, for what bends between its nodes.
constexpr double bend = 0.01;
constexpr float none = -std::numeric_limits<float>::infinity();
constexpr float unset = std::numeric_limits<float>::infinity();

/// The greatest float that is not above `value`.
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
    throw std::invalid_argument("position must hold two or more rows and columns");
  }
  check_finite(node, "position");
  Range x, y;
  for (std::size_t i = 0; i < node.size(); i += 3) {
    x.add(node[i]);
    y.add(node[i + 1]);
  }
  const double area = x.length() * y.length();
  const double quads = static_cast<double>((rows - 1) * (columns - 1));
  cell_ = std::sqrt(area / std::min(cells_per_quad * quads, most_cells));
  if (!(cell_ > 0.0) || !(std::max(x.length(), y.length()) / cell_ < most_cells)) {
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

/// The rim's quads say where the surface ends: cells that they reach into are not covered.
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
  // Held to where the grid may be, so that it fits a long; rounded down without a library's call.
  const auto index = [](double v) {
    const double held = std::clamp(v, -2.0, 1e8);
    const auto whole = static_cast<long>(held);
    return whole - (held < static_cast<double>(whole));
  };
  return {index((left - x_) / cell_), index((right - x_) / cell_), index((low - y_) / cell_),
          index((high - y_) / cell_)};
}

template <class Visit> void Occluder::visit(Cells c, const Visit& visit) const {
  std::size_t k = 0;
  for (; c.right - c.left > 2 || c.high - c.low > 2; ++k) {
    c = {c.left / 2, c.right / 2, c.low / 2, c.high / 2};
  }
  const Blocks& blocks = blocks_[k];
  for (long row = c.low; row <= c.high; ++row) {
    for (long column = c.left; column <= c.right; ++column) {
      visit(blocks, static_cast<std::size_t>(row * blocks.columns + column));
    }
  }
}

double Occluder::lowest(const Ball& ball) const {
  const auto& [at, r] = ball;
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

/// All straight lines between two balls.
class Occluder::Lines {
public:
  Lines(const Occluder& ground, const Ball& from, const Ball& to)
      : ground_(ground), from_(from), way_(minus(to.centre, from.centre)),
        grows_(to.radius - from.radius), length_(std::hypot(way_[0], way_[1])) {}

  /// Whether the ground is over all of them at the fraction t, and t is one that is tried below.
  bool blocked(double t) const { return ground_.buries(at(t)) && tried(t); }

  /// Whether it is somewhere between the fractions `a` and `b`, and where.
  bool blocked(double a, double b, double& where) const {
    const Ball first = at(a), last = at(b);
    const double top = std::min(first.centre[2] + first.radius, last.centre[2] + last.radius);
    if (!(ground_.highest(around(first, last)) > top)) {
      return false;
    }
    const double half = 0.5 * (a + b);
    const Ball middle = at(half);
    if (ground_.buries(middle)) {
      where = half;
      return true;
    }
    if (is_short(a, b)) {
      return false;
    }
    return blocked(half, b, where) || blocked(a, half, where);
  }

private:
  /// Whether the fractions between `a` and `b` are too near each other to be halved again.
  bool is_short(double a, double b) const {
    const double radius = from_.radius + 0.5 * (a + b) * grows_;
    return (b - a) * length_ <= std::max(0.5 * ground_.cell_, 0.5 * radius);
  }

  /// Whether t is the middle of a part that comes of halving.
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

  Ball at(double t) const {
    return {{from_.centre[0] + t * way_[0], from_.centre[1] + t * way_[1],
             from_.centre[2] + t * way_[2]},
            from_.radius + t * grows_};
  }
  Cells around(const Ball& a, const Ball& b) const {
    const auto low = [&](std::size_t i) {
      return std::min(a.centre[i] - a.radius, b.centre[i] - b.radius);
    };
    const auto high = [&](std::size_t i) {
      return std::max(a.centre[i] + a.radius, b.centre[i] + b.radius);
    };
    return ground_.cells(low(0), high(0), low(1), high(1));
  }

  const Occluder& ground_;
  Ball from_;
  Vector way_;
  double grows_, length_;
};

bool Occluder::hides(const Ball& camera, const Ball& thing, double& where) const {
  const Lines lines(*this, camera, thing);
  return lines.blocked(where) || lines.blocked(0.0, 1.0, where);
}

bool Occluder::buries(const Ball& ball) const {
  return lowest(ball) > ball.centre[2] + ball.radius;
}

} // namespace firetwin::lod
