#pragma once

#include "base/constants.hpp"
#include "base/vector.hpp"

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

/// Terms of geodetic coordinates that depend on the parallel or the meridian only, so that a grid
/// computes sines once per row and column.
namespace firetwin::geo {

struct SineCosine {
  double sine;
  double cosine;
};

struct Radii {
  double normal;       ///< radius of curvature in the prime vertical N of WGS84, m
  double normal_polar; ///< N (1 - e^2), m
};

/// @param sine sine of the latitude
inline Radii radii(double sine) {
  constexpr double rest = 1.0 - constants::eccentricity_squared;
  const double normal =
      constants::semi_major_axis / std::sqrt(1.0 - constants::eccentricity_squared * sine * sine);
  return {normal, normal * rest};
}

/// @param latitude degrees, NaN beyond 90
SineCosine parallel(double latitude);

/// Sine and cosine of longitude - origin (degrees), reduced without rounding.
std::vector<SineCosine> meridians(std::span<const double> longitude, double origin);

/// Sine and cosine of an angle plus `degrees`, up to 90. Branch-free Taylor series with a
/// truncation error below (pi/2)^23 / 23! < 2e-18.
inline SineCosine turned(const SineCosine& from, double degrees) {
  const double d = degrees * (std::numbers::pi / 180.0);
  const double d2 = d * d;
  double sine = 1.0, versine = 1.0; // sin d, 1 - cos d
#pragma GCC unroll 10
  for (int k = 20; k >= 2; k -= 2) {
    sine = 1.0 - d2 * (1.0 / (k * (k + 1))) * sine;
    versine = 1.0 - d2 * (1.0 / ((k + 1) * (k + 2))) * versine;
  }
  sine *= d;
  versine *= 0.5 * d2;
  return {from.sine + (from.cosine * sine - from.sine * versine),
          from.cosine - (from.sine * sine + from.cosine * versine)};
}

/// Rotation of geocentric differences into the plane of an origin's meridian (IOGP 373-7-2, method
/// 9837). r is the distance from the Earth's axis, z the distance from the equatorial plane and d
/// the longitude relative to the origin:
///   east = r sin d,  dr = r cos d - r0,  dz = z - z0,
///   north = cos(lat0) dz - sin(lat0) dr,  up = sin(lat0) dz + cos(lat0) dr.
class Origin {
public:
  Origin(double latitude, double height);

  /// @param meridian longitude relative to the origin
  /// @return m
  Vector to_local(const SineCosine& parallel, const Radii& radii, const SineCosine& meridian,
                  double height) const {
    const double r = (radii.normal + height) * parallel.cosine;
    const double dr = r * meridian.cosine - r0_;
    const double dz = (radii.normal_polar + height) * parallel.sine - z0_;
    return {r * meridian.sine, at_.cosine * dz - at_.sine * dr, at_.sine * dz + at_.cosine * dr};
  }

private:
  SineCosine at_;
  double r0_;
  double z0_;
};

} // namespace firetwin::geo
