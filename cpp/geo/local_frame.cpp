#include "geo/local_frame.hpp"

#include "geo/ellipsoid.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace firetwin::geo {
namespace {

using Range = tbb::blocked_range<std::size_t>;
constexpr std::size_t points_per_task = 4096;

GeographicLib::LocalCartesian make_cartesian(double latitude, double longitude, double height) {
  if (!(std::abs(latitude) <= 90.0) || !std::isfinite(longitude) || !std::isfinite(height)) {
    throw std::invalid_argument("the origin of a local frame needs a latitude within -90..90 "
                                "degrees, a finite longitude and a finite height");
  }
  return {latitude, longitude, height};
}

} // namespace

LocalFrame::LocalFrame(double latitude, double longitude, double height)
    : latitude_(latitude), longitude_(longitude), height_(height),
      cartesian_(make_cartesian(latitude, longitude, height)) {}

Vector LocalFrame::forward(double latitude, double longitude, double height) const {
  Vector p{};
  cartesian_.Forward(latitude, longitude, height, p[0], p[1], p[2]);
  return p;
}

void LocalFrame::forward(std::span<const double> latitude, std::span<const double> longitude,
                         std::span<const double> height, std::span<double> enu) const {
  tbb::parallel_for(Range(0, latitude.size(), points_per_task), [&](const Range& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      cartesian_.Forward(latitude[i], longitude[i], height[i], enu[3 * i], enu[3 * i + 1],
                         enu[3 * i + 2]);
    }
  });
}

void LocalFrame::forward_grid(std::span<const double> latitude, std::span<const double> longitude,
                              std::span<const double> height, std::span<double> enu) const {
  const std::size_t nx = longitude.size();
  const std::vector<SineCosine> columns = meridians(longitude, longitude_);
  const Origin origin(latitude_, height_);
  const std::size_t rows_per_task = points_per_task / (nx + 1) + 1;
  tbb::parallel_for(Range(0, latitude.size(), rows_per_task), [&](const Range& range) {
    for (std::size_t y = range.begin(); y < range.end(); ++y) {
      const SineCosine row = parallel(latitude[y]);
      const Radii row_radii = radii(row.sine);
      for (std::size_t x = 0; x < nx; ++x) {
        const std::size_t i = y * nx + x;
        const auto p = origin.to_local(row, row_radii, columns[x], height[i]);
        std::copy(p.begin(), p.end(), &enu[3 * i]);
      }
    }
  });
}

void LocalFrame::reverse(std::span<const double> enu, std::span<double> latitude,
                         std::span<double> longitude, std::span<double> height) const {
  tbb::parallel_for(Range(0, latitude.size(), points_per_task), [&](const Range& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      cartesian_.Reverse(enu[3 * i], enu[3 * i + 1], enu[3 * i + 2], latitude[i], longitude[i],
                         height[i]);
    }
  });
}

} // namespace firetwin::geo
