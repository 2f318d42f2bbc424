#pragma once

#include "lod/frustum.hpp"

#include <vector>

namespace firetwin::lod {

/// What the cameras of a moment see, and what throws shadows into it.
struct Sight {
  std::vector<Frustum> cameras; ///< none: everything counts
  Vector sun{};                 ///< unit vector towards it
  double floor = 0.0;           ///< m, height of the lowest ground, where shadows end

  /// Whether a ball is in view, or throws its shadow on a place (air or ground) that is. Under a
  /// sun lower than one degree there are no shadows.
  bool counts(const Vector& centre, double radius) const;
};

} // namespace firetwin::lod
