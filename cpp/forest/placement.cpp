#include "forest/placement.hpp"

#include "base/clones.hpp"
#include "base/interpolation.hpp"
#include "geo/axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace firetwin::forest {
namespace {

/// Per-column arrays of one row of cells.
struct Cells {
  const double *north, *east;
  const double *value, *first, *width;
  const double *before, *after;
  const double *sine, *cosine;
  const double *below, *on, *above;
  double *x, *y, *z;
  std::size_t begin, end; ///< range of columns
};

/// Constants of a row, in degrees.
struct RowOf {
  double value, first, width, before, after;
  geo::SineCosine parallel;
};

double known(double height, double weight) {
  return height == height ? weight : 0.0;
}

double or_zero(double height) {
  return height == height ? height : 0.0;
}

FIRETWIN_CLONES("avx512f", "avx2")
void place_row(const Cells& all, const RowOf& row, const geo::Origin& origin, double jitter) {
  const Cells c = all;
#pragma GCC ivdep // __restrict does not reach the arrays of a structure
  for (std::size_t i = c.begin; i < c.end; ++i) {
    const double spread_x = c.first[i] + c.east[i] * c.width[i];
    const double spread_y = row.first + c.north[i] * row.width;
    const double dx = c.value[i] + jitter * (spread_x - c.value[i]) - c.value[i];
    // The outermost cells of a grid may extend beyond a pole; they have no plants there.
    const double latitude =
        std::min(std::max(row.value + jitter * (spread_y - row.value), -90.0), 90.0);
    const double dy = latitude - row.value;
    // Fraction, 0 to 1/2, towards the neighbour on the point's side; negative for the other side.
    const double u_before = dx * c.before[i], u_after = dx * c.after[i];
    const double v_before = dy * row.before, v_after = dy * row.after;
    const double u = std::max(u_before, u_after), v = std::max(v_before, v_after);
    const bool right = u_after > u_before, up = v_after > v_before;
    const double h00 = c.on[i + 1];
    const double h01 = right ? c.on[i + 2] : c.on[i];
    const double h10 = up ? c.above[i + 1] : c.below[i + 1];
    const double left_corner = up ? c.above[i] : c.below[i];
    const double right_corner = up ? c.above[i + 2] : c.below[i + 2];
    const double h11 = right ? right_corner : left_corner;
    const auto weight = bilinear_weights(v, u);
    const double w00 = known(h00, weight[0]), w01 = known(h01, weight[1]);
    const double w10 = known(h10, weight[2]), w11 = known(h11, weight[3]);
    const double height =
        (w00 * or_zero(h00) + w01 * or_zero(h01) + (w10 * or_zero(h10) + w11 * or_zero(h11))) /
        (w00 + w01 + (w10 + w11));
    const geo::SineCosine parallel = geo::turned(row.parallel, dy);
    const geo::SineCosine meridian = geo::turned({c.sine[i], c.cosine[i]}, dx);
    const auto p = origin.to_local(parallel, geo::radii(parallel.sine), meridian, height);
    c.x[i] = p[0];
    c.y[i] = p[1];
    c.z[i] = p[2];
  }
}

} // namespace

Axis::Axis(std::span<const double> nodes)
    : value(nodes), first(nodes.size()), width(nodes.size()), before(nodes.size(), 0.0),
      after(nodes.size(), 0.0) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const geo::Extent cell = geo::cell_extent(nodes, i);
    first[i] = cell.first;
    width[i] = cell.last - cell.first;
    if (i > 0) {
      before[i] = 1.0 / (nodes[i - 1] - nodes[i]);
      after[i - 1] = 1.0 / (nodes[i] - nodes[i - 1]);
    }
  }
}

Placement::Row::Row(std::size_t columns)
    : north(columns), east(columns), x(columns), y(columns), z(columns), below(columns + 2),
      on(columns + 2), above(columns + 2) {
  for (std::size_t i = 0; i < columns; ++i) {
    north[i] = east[i] = 0.5; // for cells without a plant
  }
}

Placement::Placement(const PlantingSite& site)
    : site_(site), origin_(site.frame->latitude(), site.frame->height()), latitude_(site.latitude),
      longitude_(site.longitude) {
  for (const auto& m : geo::meridians(site.longitude, site.frame->longitude())) {
    sine_.push_back(m.sine);
    cosine_.push_back(m.cosine);
  }
}

void Placement::copy_row(std::size_t y, std::size_t first, std::size_t last,
                         Buffer<double>& out) const {
  const std::size_t columns = longitude_.value.size();
  const float* row = &site_.elevation[y * columns];
  for (std::size_t i = first > 0 ? first - 1 : 0; i < std::min(last + 1, columns); ++i) {
    out[i + 1] = std::isfinite(row[i]) ? double{row[i]} : std::numeric_limits<double>::quiet_NaN();
  }
  if (first == 0) {
    out[0] = out[1];
  }
  if (last == columns) {
    out[columns + 1] = out[columns];
  }
}

void Placement::place(std::size_t y, std::size_t first, std::size_t last, Row& row) const {
  const Axis &lat = latitude_, &lon = longitude_;
  copy_row(y > 0 ? y - 1 : y, first, last, row.below);
  copy_row(y, first, last, row.on);
  copy_row(std::min(y + 1, lat.value.size() - 1), first, last, row.above);
  const Cells cells{row.north.data(),
                    row.east.data(),
                    lon.value.data(),
                    lon.first.data(),
                    lon.width.data(),
                    lon.before.data(),
                    lon.after.data(),
                    sine_.data(),
                    cosine_.data(),
                    row.below.data(),
                    row.on.data(),
                    row.above.data(),
                    row.x.data(),
                    row.y.data(),
                    row.z.data(),
                    first,
                    last};
  place_row(cells,
            {lat.value[y], lat.first[y], lat.width[y], lat.before[y], lat.after[y],
             geo::parallel(lat.value[y])},
            origin_, site_.jitter);
}

} // namespace firetwin::forest
