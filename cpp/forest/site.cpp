#include "forest/site.hpp"

#include "forest/philox.hpp"
#include "geo/axis.hpp"

#include <algorithm>
#include <cmath>

namespace firetwin::forest {
namespace {

double jittered(std::span<const double> axis, std::size_t index, double random, double jitter) {
  const geo::Extent cell = geo::cell_extent(axis, index);
  const double spread = cell.first + random * (cell.last - cell.first);
  return axis[index] + jitter * (spread - axis[index]);
}

} // namespace

std::array<double, 4> draw(const Site& site, std::size_t cell, Use use) {
  const auto bits = philox({cell, static_cast<std::uint64_t>(use), 0, 0}, {site.seed, 0});
  return {unit(bits[0]), unit(bits[1]), unit(bits[2]), unit(bits[3])};
}

std::optional<std::array<double, 3>> place(const Site& site, std::size_t y, std::size_t x) {
  const std::size_t columns = site.longitude.size();
  const auto random = draw(site, y * columns + x, Use::place);
  // The outermost cells of a grid may reach past a pole; nothing stands there.
  const double latitude =
      std::clamp(jittered(site.latitude, y, random[0], site.jitter), -90.0, 90.0);
  const double longitude = jittered(site.longitude, x, random[1], site.jitter);
  const double height =
      geo::bilinear(site.elevation, columns, geo::bracket(site.latitude, latitude),
                    geo::bracket(site.longitude, longitude));
  if (!std::isfinite(height)) {
    return std::nullopt;
  }
  return site.frame->forward(latitude, longitude, height);
}

} // namespace firetwin::forest
