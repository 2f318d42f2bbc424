#include "geo/earth_axes.hpp"

#include <GeographicLib/Geocentric.hpp>

#include <vector>

namespace firetwin::geo {

EarthAxes earth_axes(const Vector& place) {
  double latitude = 0.0, longitude = 0.0, height = 0.0;
  std::vector<double> rotation(9); // row-major; its columns are east, north and up
  GeographicLib::Geocentric::WGS84().Reverse(place[0], place[1], place[2], latitude, longitude,
                                             height, rotation);
  return {{rotation[0], rotation[3], rotation[6]},
          {rotation[1], rotation[4], rotation[7]},
          {rotation[2], rotation[5], rotation[8]}};
}

} // namespace firetwin::geo
