#pragma once

#include "flow/lattice.hpp"

#include <array>
#include <vector>

/// Filters on dense arrays [nz][ny][nx]; edge values are replicated.
namespace firetwin::flow {

struct Shape {
  Index nz, ny, nx;
  std::size_t size() const { return static_cast<std::size_t>(nz * ny * nx); }
};

/// Gaussian blur with standard deviations `cells` along levels, rows and columns, truncated at
/// three standard deviations.
void blur(std::vector<float>& values, const Shape& shape, const std::array<double, 3>& cells);

/// Dilation: the largest value within `reach` cells along each axis.
void dilate(std::vector<float>& values, const Shape& shape, Index reach);

} // namespace firetwin::flow
