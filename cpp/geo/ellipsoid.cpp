#include "geo/ellipsoid.hpp"

#include <GeographicLib/Constants.hpp>
#include <GeographicLib/Math.hpp>

#include <cmath>
#include <numbers>

namespace firetwin::geo {

using GeographicLib::Math;

Radii radii(double sine) {
  const double f = GeographicLib::Constants::WGS84_f();
  const double e2 = f * (2.0 - f);
  const double normal = GeographicLib::Constants::WGS84_a() / std::sqrt(1.0 - e2 * sine * sine);
  return {normal, normal * (1.0 - e2)};
}

SineCosine parallel(double latitude) {
  SineCosine result{};
  Math::sincosd(Math::LatFix(latitude), result.sine, result.cosine);
  return result;
}

std::vector<SineCosine> meridians(std::span<const double> longitude, double origin) {
  std::vector<SineCosine> result(longitude.size());
  for (std::size_t x = 0; x < longitude.size(); ++x) {
    double rest = 0.0;
    const double difference = Math::AngDiff(origin, longitude[x], rest);
    Math::sincosde(difference, rest, result[x].sine, result[x].cosine);
  }
  return result;
}

SineCosine turned(const SineCosine& from, double degrees) {
  const double d = degrees * (std::numbers::pi / 180.0);
  const double d2 = d * d;
  double sine = 0.0, versine = 0.0; // sin d, 1 - cos d
  if (d2 < 1e-4) {
    // What is left out is below d^9 / 9! < 3e-24 and d^10 / 10! < 3e-27.
    sine = d * (1.0 - d2 / 6.0 * (1.0 - d2 / 20.0 * (1.0 - d2 / 42.0)));
    versine = d2 / 2.0 * (1.0 - d2 / 12.0 * (1.0 - d2 / 30.0 * (1.0 - d2 / 56.0)));
  } else {
    sine = std::sin(d);
    versine = 2.0 * std::sin(0.5 * d) * std::sin(0.5 * d);
  }
  return {from.sine + (from.cosine * sine - from.sine * versine),
          from.cosine - (from.sine * sine + from.cosine * versine)};
}

Origin::Origin(double latitude, double height) : at_(parallel(latitude)) {
  const Radii at = radii(at_.sine);
  r0_ = (at.normal + height) * at_.cosine;
  z0_ = (at.normal_polar + height) * at_.sine;
}

} // namespace firetwin::geo
