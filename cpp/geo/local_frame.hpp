#pragma once

#include "base/vector.hpp"

#include <GeographicLib/LocalCartesian.hpp>

#include <span>

namespace firetwin::geo {

/// Converts between WGS84 and local east-north-up metres. Latitudes and longitudes are in degrees,
/// heights in metres above the ellipsoid. Latitudes beyond +-90 degrees and NaN give NaN.
class LocalFrame {
public:
  /// @throws std::invalid_argument if the origin is not finite or |latitude| > 90
  LocalFrame(double latitude, double longitude, double height);

  double latitude() const { return latitude_; }
  double longitude() const { return longitude_; }
  double height() const { return height_; }

  /// Converts one point to east, north, up (GeographicLib::LocalCartesian).
  Vector forward(double latitude, double longitude, double height) const;

  /// Converts n scattered points to enu[3 n].
  void forward(std::span<const double> latitude, std::span<const double> longitude,
               std::span<const double> height, std::span<double> enu) const;

  /// Converts a rectilinear grid of ny latitudes, nx longitudes and height[ny nx] to enu[ny nx 3].
  /// Equal to `forward` within 5 nm; sines and cosines are computed per row and column instead of
  /// per point.
  void forward_grid(std::span<const double> latitude, std::span<const double> longitude,
                    std::span<const double> height, std::span<double> enu) const;

  /// Converts enu[3 n] to n latitudes, longitudes in [-180, 180] and heights.
  void reverse(std::span<const double> enu, std::span<double> latitude, std::span<double> longitude,
               std::span<double> height) const;

private:
  double latitude_;
  double longitude_;
  double height_;
  GeographicLib::LocalCartesian cartesian_;
};

} // namespace firetwin::geo
