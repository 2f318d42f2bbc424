#include "geo/local_frame.hpp"

#include <GeographicLib/Constants.hpp>
#include <GeographicLib/Math.hpp>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace firetwin::geo {
namespace {

using GeographicLib::Math;
using Range = tbb::blocked_range<std::size_t>;
constexpr std::size_t points_per_task = 4096;

GeographicLib::LocalCartesian make_cartesian(double latitude, double longitude, double height) {
  if (!(std::abs(latitude) <= 90.0) || !std::isfinite(longitude) || !std::isfinite(height)) {
    throw std::invalid_argument("the origin of a local frame needs a latitude within -90..90 "
                                "degrees, a finite longitude and a finite height");
  }
  return {latitude, longitude, height};
}

struct SineCosine {
  double sine;
  double cosine;
};

/// What the points of one parallel share.
struct Parallel {
  double sine;
  double cosine;
  double normal;       ///< radius of curvature in the prime vertical N, m
  double normal_polar; ///< N (1 - e^2), m
};

Parallel make_parallel(double latitude) {
  Parallel p{};
  Math::sincosd(Math::LatFix(latitude), p.sine, p.cosine);
  const double f = GeographicLib::Constants::WGS84_f();
  const double e2 = f * (2.0 - f);
  p.normal = GeographicLib::Constants::WGS84_a() / std::sqrt(1.0 - e2 * p.sine * p.sine);
  p.normal_polar = p.normal * (1.0 - e2);
  return p;
}

/// Sine and cosine of each longitude's difference from the origin's, reduced without rounding.
std::vector<SineCosine> meridians(std::span<const double> longitude, double origin) {
  std::vector<SineCosine> result(longitude.size());
  for (std::size_t x = 0; x < longitude.size(); ++x) {
    double rest = 0.0;
    const double difference = Math::AngDiff(origin, longitude[x], rest);
    Math::sincosde(difference, rest, result[x].sine, result[x].cosine);
  }
  return result;
}

} // namespace

LocalFrame::LocalFrame(double latitude, double longitude, double height)
    : latitude_(latitude), longitude_(longitude), height_(height),
      cartesian_(make_cartesian(latitude, longitude, height)) {}

std::array<double, 3> LocalFrame::forward(double latitude, double longitude, double height) const {
  std::array<double, 3> p{};
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

// Closed form in the plane of the origin's meridian. With r the distance from the Earth's axis, z
// the height above the equator's plane and d the longitude from the origin's:
//   east = r sin d,  dr = r cos d - r0,  dz = z - z0,
//   north = cos(lat0) dz - sin(lat0) dr,  up = sin(lat0) dz + cos(lat0) dr.
// (Rotation of geocentric differences, e.g. IOGP 373-7-2, method 9837.)
void LocalFrame::forward_grid(std::span<const double> latitude, std::span<const double> longitude,
                              std::span<const double> height, std::span<double> enu) const {
  const std::size_t nx = longitude.size();
  const std::vector<SineCosine> columns = meridians(longitude, longitude_);
  const Parallel origin = make_parallel(latitude_);
  const double r0 = (origin.normal + height_) * origin.cosine;
  const double z0 = (origin.normal_polar + height_) * origin.sine;
  const std::size_t rows_per_task = points_per_task / (nx + 1) + 1;
  tbb::parallel_for(Range(0, latitude.size(), rows_per_task), [&](const Range& range) {
    for (std::size_t y = range.begin(); y < range.end(); ++y) {
      const Parallel row = make_parallel(latitude[y]);
      const double* h = height.data() + y * nx;
      double* out = enu.data() + 3 * y * nx;
      for (std::size_t x = 0; x < nx; ++x, out += 3) {
        const double r = (row.normal + h[x]) * row.cosine;
        const double dr = r * columns[x].cosine - r0;
        const double dz = (row.normal_polar + h[x]) * row.sine - z0;
        out[0] = r * columns[x].sine;
        out[1] = origin.cosine * dz - origin.sine * dr;
        out[2] = origin.sine * dz + origin.cosine * dr;
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
