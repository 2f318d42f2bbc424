#include "forest/ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace firetwin::forest {

/// A place on one axis.
struct Ground::Spot {
  double offset; ///< degrees from the line's value
  geo::Bracket between;
};

std::vector<Ground::Line> Ground::lines(std::span<const double> axis) {
  const auto interval = [axis](std::size_t lower, std::size_t upper) {
    const double width =
        upper > lower ? axis[upper] - axis[lower] : std::numeric_limits<double>::infinity();
    return Interval{lower, upper, axis[lower], width};
  };
  std::vector<Line> result(axis.size());
  const std::size_t last = axis.size() - 1;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    const std::size_t below = i > 0 ? i - 1 : 0;
    const std::size_t above = i < last ? i : (last > 0 ? last - 1 : 0);
    result[i] = {axis[i],
                 geo::cell_extent(axis, i),
                 interval(below, std::min(below + 1, last)),
                 interval(above, std::min(above + 1, last)),
                 {}};
  }
  return result;
}

Ground::Ground(const Site& site)
    : site_(site), origin_(site.frame->latitude(), site.frame->height()),
      rows_(lines(site.latitude)), columns_(lines(site.longitude)),
      whole_(std::all_of(site.elevation.begin(), site.elevation.end(),
                         [](float h) { return std::isfinite(h); })) {
  const auto meridians = geo::meridians(site.longitude, site.frame->longitude());
  for (std::size_t x = 0; x < columns_.size(); ++x) {
    columns_[x].turn = meridians[x];
  }
  for (Line& row : rows_) {
    row.turn = geo::parallel(row.value);
  }
}

Ground::Spot Ground::spot(const Line& line, double random, double jitter, double limit) {
  const double spread = line.extent.first + random * (line.extent.last - line.extent.first);
  const double place = std::clamp(line.value + jitter * (spread - line.value), -limit, limit);
  const bool before =
      (place < line.value) == (line.extent.first < line.extent.last) && place != line.value;
  const Interval& interval = before ? line.before : line.after;
  const double fraction = std::clamp((place - interval.start) / interval.width, 0.0, 1.0);
  return {place - line.value, {interval.lower, interval.upper, fraction}};
}

double Ground::height(const geo::Bracket& y, const geo::Bracket& x) const {
  const std::size_t columns = columns_.size();
  if (!whole_) {
    return geo::bilinear(site_.elevation, columns, y, x);
  }
  const float* low = &site_.elevation[y.lower * columns];
  const float* high = &site_.elevation[y.upper * columns];
  const double v = y.fraction, u = x.fraction;
  return (1.0 - v) * ((1.0 - u) * low[x.lower] + u * low[x.upper]) +
         v * ((1.0 - u) * high[x.lower] + u * high[x.upper]);
}

bool Ground::place(std::size_t y, std::size_t x, double* out) const {
  const auto random = draw(site_, y * columns_.size() + x, Use::place);
  // The outermost cells of a grid may reach past a pole; nothing stands there.
  const Spot north = spot(rows_[y], random[0], site_.jitter, 90.0);
  const Spot east =
      spot(columns_[x], random[1], site_.jitter, std::numeric_limits<double>::infinity());
  const double h = height(north.between, east.between);
  if (!std::isfinite(h)) {
    return false;
  }
  const geo::SineCosine parallel = geo::turned(rows_[y].turn, north.offset);
  const geo::SineCosine meridian = geo::turned(columns_[x].turn, east.offset);
  origin_.to_local(parallel, geo::radii(parallel.sine), meridian, h, out);
  return true;
}

} // namespace firetwin::forest
