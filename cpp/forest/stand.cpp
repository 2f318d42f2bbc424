#include "forest/stand.hpp"

#include "forest/allometry.hpp"
#include "forest/births.hpp"
#include "forest/placement.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace firetwin::forest {
namespace {

using Range = tbb::blocked_range<std::size_t>;
constexpr double degree = std::numbers::pi / 180.0;
constexpr std::size_t block = 8;                           // cells to a side
constexpr double medium_height = 8.0, large_height = 22.0; // m

/// What a tree's random numbers are for.
enum Draw : std::uint64_t { of_model, of_rotation };

struct Stem {
  Vector position;
  double height, width;
  std::uint64_t bits;
};

/// The nine values round a cell.
class Patch {
public:
  /// Beyond the grid's edge its outermost values go on.
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

  void unknown_is_zero() {
    for (double& v : value_) {
      v = std::isfinite(v) ? v : 0.0;
    }
  }

  double largest() const { return *std::max_element(value_.begin(), value_.end()); }

  /// Bilinear between the middle and the neighbours that v and u (-1/2 to 1/2) lie towards. What is
  /// not finite is left out, and the others' weights grow.
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
    add(4, (1.0 - v) * (1.0 - u));
    add(4 + i, (1.0 - v) * u);
    add(4 + j, v * (1.0 - u));
    add(4 + j + i, v * u);
    return sum / weight;
  }

private:
  std::array<double, 9> value_;
};

/// How far towards its neighbour, 0 to 1/2, a place `d` degrees from a node is; negative towards
/// the one before.
double towards(double d, double before, double after) {
  return d * after > d * before ? d * after : -d * before;
}

/// Grows the trees of cells. Immutable; what is remembered comes with each call.
class Grower {
public:
  Grower(std::span<const float> fuel, const Site& site, std::span<const float> kept)
      : fuel_(fuel), kept_(kept), site_(site),
        origin_(site.frame->latitude(), site.frame->height()), latitude_(site.latitude),
        longitude_(site.longitude),
        meridian_(geo::meridians(site.longitude, site.frame->longitude())) {
    const auto middle = geo::parallel(0.5 * (site.latitude.front() + site.latitude.back()));
    const auto radii = geo::radii(middle.sine);
    north_ = degree * std::pow(radii.normal / geo::semi_major, 2.0) * radii.normal_polar;
    cosine_ = std::max(middle.cosine, 1.0e-6);
    east_ = degree * radii.normal * cosine_;
  }

  /// Appends the trees of a cell.
  void grow(std::size_t y, std::size_t x, Births& births, std::vector<Stem>& out) const {
    const std::size_t rows = site_.latitude.size(), columns = site_.longitude.size();
    const std::size_t cell = y * columns + x;
    if (!(double{fuel_[cell]} > least_canopy_fuel) || !std::isfinite(fuel_[cell]) ||
        !std::isfinite(site_.elevation[cell])) {
      return;
    }
    Patch fuel(fuel_, rows, columns, y, x);
    fuel.unknown_is_zero();
    const Patch ground(site_.elevation, rows, columns, y, x);
    const geo::SineCosine parallel = geo::parallel(latitude_.value[y]);
    const double stretch = parallel.cosine / cosine_; // of the plane
    const auto part = [&] {
      Patch patch(kept_.empty() ? fuel_ : kept_, rows, columns, y, x);
      patch.unknown_is_zero();
      return patch;
    }();
    const auto kept = [&](double v, double u) {
      return kept_.empty() ? 1.0 : std::clamp(part.at(v, u), 0.0, 1.0);
    };
    const double most = stems(fuel.largest()) * stretch *
                        (kept_.empty() ? 1.0 : std::clamp(part.largest(), 0.0, 1.0));
    const Extent plane = extent(y, x);
    births.visit(plane.left, plane.right, plane.low, plane.high, Births::last_chance * most,
                 [&](const Births::Birth& birth) {
                   const double dx = birth.x / east_ - (longitude_.value[x] - longitude_.value[0]);
                   const double dy = birth.y / north_ - (latitude_.value[y] - latitude_.value[0]);
                   const double u = towards(dx, longitude_.before[x], longitude_.after[x]);
                   const double v = towards(dy, latitude_.before[y], latitude_.after[y]);
                   const double here = fuel.at(v, u), left = kept(v, u);
                   const double all = std::min(stems(here) * stretch, most_stems);
                   const double density = all * left;
                   if (!(birth.time < Births::last_chance * density) ||
                       !births.stands(birth, Births::reach(density))) {
                     return;
                   }
                   const double rank = Births::older(birth.time, all);
                   const auto at = geo::turned(parallel, dy);
                   out.push_back({origin_.to_local(at, geo::radii(at.sine),
                                                   geo::turned(meridian_[x], dx), ground.at(v, u)),
                                  height(here, std::max(rank, 1.0e-9)), widening(here, left),
                                  birth.bits});
                 });
  }

private:
  struct Extent {
    double left, right, low, high;
  };

  /// Of a cell on the plane, m from the grid's first node.
  Extent extent(std::size_t y, std::size_t x) const {
    const auto ends = [](const Axis& axis, std::size_t i, double scale) {
      const double a = (axis.first[i] - axis.value[0]) * scale, b = a + axis.width[i] * scale;
      return std::array{std::min(a, b), std::max(a, b)};
    };
    const auto [left, right] = ends(longitude_, x, east_);
    const auto [low, high] = ends(latitude_, y, north_);
    return {left, right, low, high};
  }

  std::span<const float> fuel_, kept_;
  const Site& site_;
  geo::Origin origin_;
  Axis latitude_, longitude_;
  std::vector<geo::SineCosine> meridian_;
  double north_, east_, cosine_; ///< m per degree; of the middle latitude
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

Stems stand(std::span<const float> canopy_fuel, const Site& site, std::span<const float> kept) {
  const std::size_t rows = site.latitude.size(), columns = site.longitude.size();
  if (rows == 0 || columns == 0) {
    return make_stems(0);
  }
  const Grower grower(canopy_fuel, site, kept);
  struct RowOf {
    std::vector<Stem> stems;
    std::vector<std::size_t> last; ///< of each cell's stems
  };
  std::vector<RowOf> grown(rows);
  tbb::enumerable_thread_specific<Births> births(site.seed);
  tbb::parallel_for(Range(0, rows, block), [&](const Range& range) {
    Births& mine = births.local();
    for (std::size_t y = range.begin(); y < range.end(); ++y) {
      grown[y].last.resize(columns);
    }
    for (std::size_t first = 0; first < columns; first += block) { // squares in reach are shared
      for (std::size_t y = range.begin(); y < range.end(); ++y) {
        for (std::size_t x = first; x < std::min(first + block, columns); ++x) {
          if (site.mask.empty() || site.mask[y * columns + x]) {
            grower.grow(y, x, mine, grown[y].stems);
          }
          grown[y].last[x] = grown[y].stems.size();
        }
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
      const RowOf row = std::move(grown[y]);
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
