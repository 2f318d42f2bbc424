#pragma once

#include "tiles/assembler.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace firetwin::tiles {

/// Converts a list, strip or fan of corners (glTF modes 4, 5, 6) to a list of triangles. Incomplete
/// triangles at the end are dropped.
std::vector<std::uint32_t> list_triangles(std::vector<std::uint32_t> corners, std::size_t mode);

/// Drops triangles with a vertex that is not finite or with two equal corners.
void drop_invalid_triangles(const std::vector<float>& position,
                            std::vector<std::uint32_t>& triangles);

/// Returns the vertices that triangles use, ascending, and renumbers the triangles to them.
std::vector<std::uint32_t> compact_vertices(std::size_t vertices,
                                            std::vector<std::uint32_t>& triangles);

/// Smooth normals (n x 3): area-weighted sums over all corners at the same position, so that
/// vertices split at texture seams get equal normals.
std::vector<float> smooth_normals(const std::vector<float>& position,
                                  const std::vector<std::uint32_t>& triangles);

} // namespace firetwin::tiles
