#pragma once

#include "lod/view_set.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace firetwin::tiles {

/// Bounding volumes of n tiles: boxes, widened by a padding. A sphere is a box without extent.
struct Volumes {
  std::span<const double> centre;  ///< [3 n] m
  std::span<const double> axis;    ///< [9 n] orthonormal rows: directions of the box's edges
  std::span<const double> half;    ///< [3 n] half lengths of the edges, m
  std::span<const double> padding; ///< [n] m by which the box is widened

  std::size_t size() const { return padding.size(); }
  /// Distance of a place from the nearest point of volume i, m; 0 inside.
  double distance(std::size_t i, const Vector& place) const;
  lod::BoundingSphere sphere(std::size_t i) const;
};

/// Screen-space error in pixels of each tile: the largest over the views that see its volume; -1
/// where none does (3D Tiles specification; cesium-native ViewState::computeScreenSpaceError).
/// Perspective: error * pixels / max(distance, 1e-7 m). Orthographic: error * pixels.
/// @param error [n] geometric errors, m
/// @param pixels of each view. Perspective: pixels of 1 m at a distance of 1 m, in the picture's
///        centre. Orthographic: pixels of 1 m.
/// @throws std::invalid_argument for negative numbers and a wrong number of `pixels`.
void screen_error(const Volumes& volumes, std::span<const double> error,
                  const lod::ViewSet& view_set, std::span<const double> pixels,
                  const lod::CullOptions& options, std::span<double> out);

/// Whether any of some places lies inside each volume.
/// @param place [3 m] m
void contains_any(const Volumes& volumes, std::span<const double> place, std::span<bool> out);

} // namespace firetwin::tiles
