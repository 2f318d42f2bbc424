#pragma once

#include "base/vector.hpp"

#include <GeographicLib/LocalCartesian.hpp>

#include <span>

namespace firetwin::geo {

/// WGS84 <-> local east-north-up metres about one origin. Longitude, latitude in degrees, heights
/// in metres above the ellipsoid. Latitudes beyond +-90 degrees and NaN give NaN.
class LocalFrame {
public:
  /// @throws std::invalid_argument when the origin is not finite or |latitude| > 90.
  LocalFrame(double latitude, double longitude, double height);

  double latitude() const { return latitude_; }
  double longitude() const { return longitude_; }
  double height() const { return height_; }

  /// One point -> east, north, up (GeographicLib::LocalCartesian).
  Vector forward(double latitude, double longitude, double height) const;

  /// n scattered points -> enu[3 n].
  void forward(std::span<const double> latitude, std::span<const double> longitude,
               std::span<const double> height, std::span<double> enu) const;

  /// Rectilinear grid: ny latitudes, nx longitudes, height[ny nx] -> enu[ny nx 3]. The same result
  /// within 5 nm, with sines and cosines once per row and column instead of once per point.
  void forward_grid(std::span<const double> latitude, std::span<const double> longitude,
                    std::span<const double> height, std::span<double> enu) const;

  /// enu[3 n] -> n latitudes, longitudes in [-180, 180] and heights.
  void reverse(std::span<const double> enu, std::span<double> latitude, std::span<double> longitude,
               std::span<double> height) const;

private:
  double latitude_;
  double longitude_;
  double height_;
  GeographicLib::LocalCartesian cartesian_;
};

} // namespace firetwin::geo
