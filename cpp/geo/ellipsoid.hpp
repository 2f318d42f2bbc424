#pragma once

#include <span>
#include <vector>

/// What points of one parallel or one meridian share, so that a grid needs its sines once per row
/// and column.
namespace firetwin::geo {

struct SineCosine {
  double sine;
  double cosine;
};

struct Radii {
  double normal;       ///< radius of curvature in the prime vertical N of WGS84, m
  double normal_polar; ///< N (1 - e^2), m
};

/// @param sine of the latitude
Radii radii(double sine);

/// @param latitude degrees, NaN beyond 90
SineCosine parallel(double latitude);

/// Sine and cosine of each longitude's difference from the origin's (degrees), reduced without
/// rounding.
std::vector<SineCosine> meridians(std::span<const double> longitude, double origin);

/// Sine and cosine of an angle that is `degrees` further on. Taylor series where that is little,
/// accurate to the rounding of the result.
SineCosine turned(const SineCosine& from, double degrees);

/// Rotation of geocentric differences into the plane of an origin's meridian (IOGP 373-7-2, method
/// 9837). With r the distance from the Earth's axis, z the height above the equator's plane and d
/// the longitude from the origin's:
///   east = r sin d,  dr = r cos d - r0,  dz = z - z0,
///   north = cos(lat0) dz - sin(lat0) dr,  up = sin(lat0) dz + cos(lat0) dr.
class Origin {
public:
  Origin(double latitude, double height);

  /// @param parallel, radii of the point; meridian: its longitude from the origin's; out: 3 m
  void to_local(const SineCosine& parallel, const Radii& radii, const SineCosine& meridian,
                double height, double* out) const {
    const double r = (radii.normal + height) * parallel.cosine;
    const double dr = r * meridian.cosine - r0_;
    const double dz = (radii.normal_polar + height) * parallel.sine - z0_;
    out[0] = r * meridian.sine;
    out[1] = at_.cosine * dz - at_.sine * dr;
    out[2] = at_.sine * dz + at_.cosine * dr;
  }

private:
  SineCosine at_;
  double r0_;
  double z0_;
};

} // namespace firetwin::geo
