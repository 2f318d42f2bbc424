#include "geo/ellipsoid.hpp"

#include <GeographicLib/Math.hpp>

namespace firetwin::geo {

using GeographicLib::Math;

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

Origin::Origin(double latitude, double height) : at_(parallel(latitude)) {
  const Radii at = radii(at_.sine);
  r0_ = (at.normal + height) * at_.cosine;
  z0_ = (at.normal_polar + height) * at_.sine;
}

} // namespace firetwin::geo
