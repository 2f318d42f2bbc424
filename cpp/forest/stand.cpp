#include "forest/stand.hpp"

#include "base/clones.hpp"
#include "base/interpolation.hpp"
#include "forest/allometry.hpp"
#include "forest/matern_process.hpp"
#include "forest/placement.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace firetwin::forest {
namespace {

using Range = tbb::blocked_range<std::size_t>;
constexpr double degree = std::numbers::pi / 180.0;
constexpr std::size_t block = 8;                           // cells per side
constexpr double medium_height = 8.0, large_height = 22.0; // m

/// Uses of a tree's random numbers.
enum Draw : std::uint64_t { of_model, of_rotation };

struct Stem {
  Vector position;
  double height, width;
  std::uint64_t bits;
};

/// The 3 x 3 values around a cell.
class Patch {
public:
  /// Values outside the grid are replicated from its edge.
  Patch(std::span<const float> values, std::size_t rows, std::size_t columns, std::size_t y,
        std::size_t x) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t row = std::min(y + j > 0 ? y + j - 1 : 0, rows - 1);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t column = std::min(x + i > 0 ? x + i - 1 : 0, columns - 1);
        value_[3 * j + i] = double{values[row * columns + column]};
      }
    }
  }

  explicit Patch(double everywhere) { value_.fill(everywhere); }

  void unknown_is_zero() {
    for (double& v : value_) {
      v = std::isfinite(v) ? v : 0.0;
    }
  }

  /// Largest of the four values around a quarter of the cell.
  double largest(std::size_t quarter) const {
    const std::size_t first = 3 * (quarter / 2) + quarter % 2;
    return std::max({value_[first], value_[first + 1], value_[first + 3], value_[first + 4]});
  }

  /// Bilinear interpolation at v and u (-1/2 to 1/2 from the centre). Values that are not finite
  /// are skipped, and the other weights are renormalized.
  double at(double v, double u) const {
    const int j = v > 0.0 ? 3 : -3, i = u > 0.0 ? 1 : -1;
    v = std::abs(v);
    u = std::abs(u);
    double sum = 0.0, weight = 0.0;
    const auto add = [&](int place, double w) {
      const double value = value_[static_cast<std::size_t>(place)];
      if (std::isfinite(value)) {
        sum += w * value;
        weight += w;
      }
    };
    const auto [here, beside, next, across] = bilinear_weights(v, u);
    add(4, here);
    add(4 + i, beside);
    add(4 + j, next);
    add(4 + j + i, across);
    return sum / weight;
  }

  /// Fast version for finite values.
  double known(double v, double u) const {
    const double below = u > 0.0 ? value_[2] : value_[0], above = u > 0.0 ? value_[8] : value_[6];
    const double beside = u > 0.0 ? value_[5] : value_[3];
    const double next = v > 0.0 ? value_[7] : value_[1], across = v > 0.0 ? above : below;
    v = std::abs(v);
    u = std::abs(u);
    const auto [w, w_u, w_v, w_uv] = bilinear_weights(v, u);
    return (w * value_[4] + w_u * beside + w_v * next + w_uv * across) / (w + w_u + w_v + w_uv);
  }

private:
  std::array<double, 9> value_;
};

/// A cell that can have trees.
struct Cell {
  Patch fuel, ground, retained;
  geo::SineCosine parallel; ///< of its centre
  double stretch;           ///< area on the ground / area on the plane
  /// Upper bound of marks in each quarter: low left, low right, high left, high right.
  std::array<double, 4> latest;
  /// Without thinning, the square of that bound is at most `steady` + `rising` * fuel.
  std::array<double, 4> steady, rising;
};

/// Factor that keeps a bound valid under rounding.
constexpr double rounding = 1.0 + 1.0e-9;

/// Position of a cell along an axis.
struct Across {
  double scale;         ///< m of the plane per degree
  double middle;        ///< degrees from the grid's first node
  double before, after; ///< as in `Axis`

  /// Degrees from the cell's centre of a position on the plane (m).
  double degrees(double place) const { return place / scale - middle; }
  /// Fraction, 0 to 1/2, towards the neighbour of a point `d` degrees from the centre; negative
  /// towards the previous one.
  double towards(double d) const { return d * after > d * before ? d * after : -d * before; }
};

/// Parameters of the tests of points in a cell.
struct Rule {
  const Cell& cell;
  Across x, y;
};

/// Points of a cell with their bounds.
struct CandidatePoints : MaternProcess::PointArrays {
  std::vector<double> fuel, retained;
  std::vector<double> latest; ///< upper bound of the mark at each point; 0 if the point exceeds it

  void judge(const Rule& rule) {
    if (fuel.size() < size) {
      fuel.resize(2 * size);
      retained.resize(2 * size);
      latest.resize(2 * size);
    }
    judge(rule, size, x.data(), y.data(), mark.data(), fuel.data(), retained.data(), latest.data());
  }

private:
  static void judge(const Rule& rule, std::size_t n, const double* x, const double* y,
                    const double* mark, double* fuel, double* retained, double* latest);
};

/// Branch-free, so that it vectorizes.
FIRETWIN_CLONES("avx512f", "avx2")
void CandidatePoints::judge(const Rule& rule, std::size_t n, const double* x, const double* y,
                            const double* mark, double* __restrict fuel,
                            double* __restrict retained, double* __restrict latest) {
  const Patch fuels = rule.cell.fuel, parts = rule.cell.retained;
  const std::array<double, 4> end = rule.cell.latest, steady = rule.cell.steady,
                              rising = rule.cell.rising;
  const Across east = rule.x, north = rule.y;
  for (std::size_t i = 0; i < n; ++i) {
    const double u = east.towards(east.degrees(x[i])), v = north.towards(north.degrees(y[i]));
    const auto quarter = [&](const std::array<double, 4>& of) {
      const double low = u > 0.0 ? of[1] : of[0], high = u > 0.0 ? of[3] : of[2];
      return v > 0.0 ? high : low;
    };
    const double here = fuels.known(v, u);
    const double left = std::min(std::max(parts.known(v, u), 0.0), 1.0);
    const double square = (quarter(steady) + quarter(rising) * here) * (left * left);
    const bool can = (mark[i] < quarter(end)) & (mark[i] * mark[i] < square);
    fuel[i] = here;
    retained[i] = left;
    latest[i] = can ? std::sqrt(square) * rounding : 0.0;
  }
}

/// Generates the trees of cells. Immutable; work space is passed with each call.
class Grower {
public:
  Grower(std::span<const float> fuel, const PlantingSite& site, std::span<const float> retained)
      : fuel_(fuel), retained_(retained), site_(site),
        origin_(site.frame->latitude(), site.frame->height()), latitude_(site.latitude),
        longitude_(site.longitude),
        meridian_(geo::meridians(site.longitude, site.frame->longitude())) {
    const auto middle = geo::parallel(0.5 * (site.latitude.front() + site.latitude.back()));
    const auto radii = geo::radii(middle.sine);
    north_ = degree * std::pow(radii.normal / constants::semi_major_axis, 2.0) * radii.normal_polar;
    cosine_ = std::max(middle.cosine, 1.0e-6);
    east_ = degree * radii.normal * cosine_;
  }

  /// Returns the cell; empty if it cannot have trees.
  std::optional<Cell> cell(std::size_t y, std::size_t x) const {
    const std::size_t rows = site_.latitude.size(), columns = site_.longitude.size();
    const std::size_t number = y * columns + x;
    if (!(site_.mask.empty() || site_.mask[number]) || !(double{fuel_[number]} > min_canopy_fuel) ||
        !std::isfinite(fuel_[number]) || !std::isfinite(site_.elevation[number])) {
      return std::nullopt;
    }
    const geo::SineCosine parallel = geo::parallel(latitude_.value[y]);
    Cell cell{Patch(fuel_, rows, columns, y, x),
              Patch(site_.elevation, rows, columns, y, x),
              retained_.empty() ? Patch(1.0) : Patch(retained_, rows, columns, y, x),
              parallel,
              parallel.cosine / cosine_,
              {},
              {},
              {}};
    cell.fuel.unknown_is_zero();
    cell.retained.unknown_is_zero();
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
      const double left = std::clamp(cell.retained.largest(quarter), 0.0, 1.0);
      const double most = cell.fuel.largest(quarter), all = stems_of(most, cell.stretch);
      const double latest = rounding * MaternProcess::max_mark_ratio * all;
      cell.latest[quarter] = latest * left;
      // Stem density grows faster than the square root of the fuel, up to max_stem_density.
      const bool grow = all * std::max(1.0 / cell.stretch, 1.0) < 0.999 * max_stem_density;
      cell.steady[quarter] = grow ? 0.0 : latest * latest;
      cell.rising[quarter] = grow ? latest * latest / most : 0.0;
    }
    return cell;
  }

  /// Appends the trees of a cell; its points must be gathered.
  void grow(const Cell& cell, std::size_t y, std::size_t x, const MaternProcess& points,
            CandidatePoints& work, std::vector<Stem>& out) const {
    const double latest = *std::max_element(cell.latest.begin(), cell.latest.end());
    points.find(area(y, x), latest, work);
    const Rule rule{cell, across(longitude_, x, east_), across(latitude_, y, north_)};
    work.judge(rule);
    for (std::size_t i = 0; i < work.size; ++i) {
      if (!(work.mark[i] < work.latest[i])) {
        continue;
      }
      const MaternProcess::MarkedPoint point{work.x[i], work.y[i], work.mark[i], work.bits[i]};
      // An upper bound of the stem density, which is cheaper than the density.
      if (!points.is_retained(
              point, MaternProcess::exclusion_area(std::min(
                         work.latest[i] / MaternProcess::max_mark_ratio, max_stem_density)))) {
        continue;
      }
      const double here = work.fuel[i], left = work.retained[i];
      const double all = stems_of(here, cell.stretch), density = all * left;
      if (!(point.mark < MaternProcess::max_mark_ratio * density) ||
          !points.is_retained(point, MaternProcess::exclusion_area(density))) {
        continue;
      }
      const double dx = rule.x.degrees(point.x), dy = rule.y.degrees(point.y);
      const double rank = MaternProcess::older_fraction(point.mark, all);
      const auto at = geo::turned(cell.parallel, dy);
      out.push_back({origin_.to_local(at, geo::radii(at.sine), geo::turned(meridian_[x], dx),
                                      cell.ground.at(rule.y.towards(dy), rule.x.towards(dx))),
                     height(here, std::max(rank, 1.0e-9)), crown_widening(here, left), point.bits});
    }
  }

  /// Area of a cell on the plane, m from the grid's first node.
  Area area(std::size_t y, std::size_t x) const {
    const auto ends = [](const Axis& axis, std::size_t i, double scale) {
      const double a = (axis.first[i] - axis.value[0]) * scale, b = a + axis.width[i] * scale;
      return std::array{std::min(a, b), std::max(a, b)};
    };
    const auto [left, right] = ends(longitude_, x, east_);
    const auto [low, high] = ends(latitude_, y, north_);
    return {left, right, low, high};
  }

private:
  static Across across(const Axis& axis, std::size_t i, double scale) {
    return {scale, axis.value[i] - axis.value[0], axis.before[i], axis.after[i]};
  }

  static double stems_of(double fuel, double stretch) {
    return std::min(stems(fuel) * stretch, max_stem_density);
  }

  std::span<const float> fuel_, retained_;
  const PlantingSite& site_;
  geo::Origin origin_;
  Axis latitude_, longitude_;
  std::vector<geo::SineCosine> meridian_;
  double north_, east_, cosine_; ///< m per degree north and east; cosine of the central latitude
};

/// Trees of a row of cells, and the end of each cell's trees.
struct StemRow {
  std::vector<Stem> stems;
  std::vector<std::size_t> last;
};

/// Work space of a thread.
struct Worker {
  explicit Worker(std::uint64_t seed) : points(seed) {}
  MaternProcess points;
  CandidatePoints judged;
};

/// A block of cells. Points are gathered for as many cells as fit into the processor's cache.
class Block {
public:
  Block(const Grower& grower, Worker& worker, std::span<StemRow> rows, std::size_t y, std::size_t x,
        std::size_t height, std::size_t width)
      : grower_(grower), worker_(worker), rows_(rows), y_(y), x_(x), height_(height),
        width_(width) {
    for (std::size_t j = 0; j < height; ++j) {
      for (std::size_t i = 0; i < width; ++i) {
        cells_.push_back(grower.cell(y + j, x + i));
      }
    }
  }

  void grow() { grow(0, height_, 0, width_); }

private:
  static constexpr double at_once = 16384.0; ///< points gathered at once

  /// Grows rows low to high - 1 and columns left to right - 1, from left to right.
  void grow(std::size_t low, std::size_t high, std::size_t left, std::size_t right) {
    double latest = 0.0;
    Area all{};
    for (std::size_t j = low; j < high; ++j) {
      for (std::size_t i = left; i < right; ++i) {
        if (const auto& cell = at(j, i)) {
          const Area one = grower_.area(y_ + j, x_ + i);
          all = latest > 0.0 ? join(all, one) : one;
          latest = std::max(latest, *std::max_element(cell->latest.begin(), cell->latest.end()));
        }
      }
    }
    if (latest * (all.right - all.left) * (all.high - all.low) > at_once) {
      if (const std::size_t half = (right - left) / 2; half > 0 && right - left >= high - low) {
        grow(low, high, left, left + half);
        grow(low, high, left + half, right);
        return;
      } else if (high - low > 1) {
        const std::size_t middle = low + (high - low) / 2;
        grow(low, middle, left, right);
        grow(middle, high, left, right);
        return;
      }
    }
    if (latest > 0.0) {
      worker_.points.gather(all, latest);
    }
    for (std::size_t j = low; j < high; ++j) {
      StemRow& row = rows_[y_ + j];
      for (std::size_t i = left; i < right; ++i) {
        if (const auto& cell = at(j, i)) {
          grower_.grow(*cell, y_ + j, x_ + i, worker_.points, worker_.judged, row.stems);
        }
        row.last[x_ + i] = row.stems.size();
      }
    }
  }

  const std::optional<Cell>& at(std::size_t j, std::size_t i) const {
    return cells_[j * width_ + i];
  }
  static Area join(const Area& a, const Area& b) {
    return {std::min(a.left, b.left), std::max(a.right, b.right), std::min(a.low, b.low),
            std::max(a.high, b.high)};
  }

  const Grower& grower_;
  Worker& worker_;
  std::span<StemRow> rows_;
  std::size_t y_, x_, height_, width_;
  std::vector<std::optional<Cell>> cells_;
};

Stems make_stems(std::size_t n) {
  return {{Buffer<std::int64_t>(n), Buffer<double>(3 * n), Buffer<std::uint8_t>(n),
           Buffer<std::uint8_t>(n), Buffer<float>(n), Buffer<float>(n)},
          Buffer<float>(n),
          Buffer<std::int64_t>(n)};
}

void write(Stems& out, std::size_t i, std::size_t cell, const Stem& stem) {
  const SizeClass kind = stem.height >= large_height    ? large_tree
                         : stem.height >= medium_height ? medium_tree
                                                        : small_tree;
  out.cell[i] = static_cast<std::int64_t>(cell);
  std::copy(stem.position.begin(), stem.position.end(), &out.position[3 * i]);
  out.size_class[i] = kind;
  out.model[i] = static_cast<std::uint8_t>(uniform(stem.bits, of_model) * models(kind));
  out.scale[i] = static_cast<float>(stem.height);
  out.rotation[i] = static_cast<float>(2.0 * std::numbers::pi * uniform(stem.bits, of_rotation));
  out.width[i] = static_cast<float>(stem.width);
  out.key[i] = static_cast<std::int64_t>(stem.bits);
}

} // namespace

Stems stand(std::span<const float> canopy_fuel, const PlantingSite& site,
            std::span<const float> retained) {
  const std::size_t rows = site.latitude.size(), columns = site.longitude.size();
  if (rows == 0 || columns == 0) {
    return make_stems(0);
  }
  const Grower grower(canopy_fuel, site, retained);
  std::vector<StemRow> grown(rows);
  tbb::enumerable_thread_specific<Worker> workers(site.seed);
  tbb::parallel_for(Range(0, (rows + block - 1) / block), [&](const Range& range) {
    Worker& mine = workers.local();
    for (std::size_t line = range.begin(); line < range.end(); ++line) {
      const std::size_t y = line * block, height = std::min(block, rows - y);
      for (std::size_t j = y; j < y + height; ++j) {
        grown[j].last.resize(columns);
      }
      for (std::size_t x = 0; x < columns; x += block) {
        Block(grower, mine, grown, y, x, height, std::min(block, columns - x)).grow();
      }
    }
  });
  std::vector<std::size_t> offset(rows + 1, 0);
  for (std::size_t y = 0; y < rows; ++y) {
    offset[y + 1] = offset[y] + grown[y].stems.size();
  }
  Stems out = make_stems(offset.back());
  tbb::parallel_for(Range(0, rows), [&](const Range& range) {
    for (std::size_t y = range.begin(); y < range.end(); ++y) {
      const StemRow row = std::move(grown[y]);
      for (std::size_t x = 0, i = 0; x < columns; ++x) {
        for (; i < row.last[x]; ++i) {
          write(out, offset[y] + i, y * columns + x, row.stems[i]);
        }
      }
    }
  });
  return out;
}

} // namespace firetwin::forest
