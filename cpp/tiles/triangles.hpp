#pragma once

#include "tiles/assembler.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace firetwin::tiles {

/// Triangles of a list, a strip or a fan of corners (glTF modes 4, 5, 6); what is left over at the
/// end is dropped.
std::vector<std::uint32_t> list_triangles(std::vector<std::uint32_t> corners, std::size_t mode);

/// Leaves out triangles with a vertex that is not finite, or with one corner twice.
void drop_invalid_triangles(const std::vector<float>& position,
                            std::vector<std::uint32_t>& triangles);

/// Which vertices triangles use, in order; triangles are numbered anew.
std::vector<std::uint32_t> compact_vertices(std::size_t vertices,
                                            std::vector<std::uint32_t>& triangles);

/// Smooth normals (n x 3): sums over corners at the same place of triangles' normals by area. Those
/// are orthogonal to the surface whether or not its vertices are split at seams of the texture.
std::vector<float> smooth_normals(const std::vector<float>& position,
                                  const std::vector<std::uint32_t>& triangles);

} // namespace firetwin::tiles
