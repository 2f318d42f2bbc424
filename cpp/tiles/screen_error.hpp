#pragma once

#include "lod/view_set.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::tiles {

/// Bounding volumes of n tiles: oriented boxes, each padded by the radius of a sphere. A sphere is
/// a box with half lengths of 0.
struct Volumes {
  std::span<const double> centre;  ///< [3 n] m
  std::span<const double> axis;    ///< [9 n] orthonormal directions of the edges, as rows
  std::span<const double> half;    ///< [3 n] half lengths of the edges, m
  std::span<const double> padding; ///< [n] padding radius, m

  std::size_t size() const { return padding.size(); }
  /// Distance of a point from volume i, m; 0 inside.
  double distance(std::size_t i, const Vector& place) const;
  lod::BoundingSphere sphere(std::size_t i) const;
};

/// Computes the screen-space error of each tile in pixels: the maximum over the views that see its
/// volume, or -1 if no view sees it (3D Tiles specification; cesium-native
/// ViewState::computeScreenSpaceError). Perspective: error * pixels / max(distance, 1e-7 m).
/// Orthographic: error * pixels.
/// @param error [n] geometric errors, m
/// @param pixels scale of each view. Perspective: pixels per metre at a distance of 1 m, in the
/// image centre. Orthographic: pixels per metre.
/// @throws std::invalid_argument for negative numbers or a wrong number of `pixels`
void screen_error(const Volumes& volumes, std::span<const double> error,
                  const lod::ViewSet& view_set, std::span<const double> pixels,
                  const lod::CullOptions& options, std::span<double> out);

/// Tests for each volume whether it contains at least one of the points.
/// @param place [3 m] points, m
void contains_any(const Volumes& volumes, std::span<const double> place, std::span<bool> out);

} // namespace firetwin::tiles
