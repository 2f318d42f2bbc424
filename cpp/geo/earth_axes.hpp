#pragma once

#include "base/vector.hpp"

namespace firetwin::geo {

/// East, north and up directions at a point, in Earth-centred axes.
struct EarthAxes {
  Vector east;
  Vector north;
  Vector up;
};

/// @param place Earth-centred, Earth-fixed, m
EarthAxes earth_axes(const Vector& place);

} // namespace firetwin::geo
