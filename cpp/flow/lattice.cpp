#include "flow/lattice.hpp"

#include "base/check.hpp"

#include <stdexcept>
#include <utility>

namespace firetwin::flow {
namespace {

constexpr Index least = 8;
constexpr Index most = 4096;

void check_levels(const std::vector<double>& levels) {
  check_finite(levels, "levels");
  if (levels.size() < 5 || levels.front() != 0.0) {
    throw std::invalid_argument("levels must be at least 5 heights, the first of them 0");
  }
  for (std::size_t k = 1; k < levels.size(); ++k) {
    if (!(levels[k] > levels[k - 1])) {
      throw std::invalid_argument("levels must be strictly increasing");
    }
  }
}

} // namespace

Lattice::Lattice(Index columns, Index rows, double cell, std::vector<double> levels)
    : nx(columns), ny(rows), nz(static_cast<Index>(levels.size()) - 1), spacing(cell),
      face(std::move(levels)) {
  check_above_zero(cell, "spacing");
  check_levels(face);
  if (nx < least || ny < least || nx > most || ny > most || nz > most) {
    throw std::invalid_argument("shape must be 8 to 4096 rows and columns, with 4 to 4096 levels");
  }
  for (std::size_t k = 0; k + 1 < face.size(); ++k) {
    middle.push_back(0.5 * (face[k] + face[k + 1]));
    depth.push_back(face[k + 1] - face[k]);
  }
  stride = whole_lanes(nx) + lanes;
  plane = stride * (ny + 2 * halo);
}

double Lattice::gap(Index k) const {
  const auto above = static_cast<std::size_t>(k);
  return middle[above] - middle[above - 1];
}

} // namespace firetwin::flow
