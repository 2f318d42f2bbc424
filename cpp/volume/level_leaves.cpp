#include "volume/level_leaves.hpp"

#include "volume/grids.hpp"
#include "volume/leaf.hpp"

#include <algorithm>

namespace firetwin::volume {
namespace {

/// Where the nodes of the levels lie in the local frame.
class LevelNodes {
public:
  LevelNodes(const geo::LocalFrame& frame, const Levels& levels)
      : rows_(levels.latitude.size()), columns_(levels.longitude.size()),
        places_(levels.levels + 1, std::vector<double>(3 * rows_ * columns_)) {
    const std::size_t plane = rows_ * columns_;
    for (std::size_t level = 0; level < places_.size(); ++level) {
      const std::span<const float> from =
          level == 0 ? levels.ground : levels.height.subspan((level - 1) * plane, plane);
      const std::vector<double> height(from.begin(), from.end());
      frame.forward_grid(levels.latitude, levels.longitude, height, places_[level]);
    }
  }

  /// The box round a cell of a level: its neighbours, and those below and above. Below the lowest
  /// is the ground, to which its smoke reaches.
  openvdb::BBoxd round(std::size_t level, std::size_t row, std::size_t column) const {
    openvdb::BBoxd box;
    for (std::size_t k = level; k <= std::min(level + 2, places_.size() - 1); ++k) {
      for (std::size_t y = row > 0 ? row - 1 : 0; y <= std::min(row + 1, rows_ - 1); ++y) {
        for (std::size_t x = column > 0 ? column - 1 : 0; x <= std::min(column + 1, columns_ - 1);
             ++x) {
          const double* at = &places_[k][3 * (y * columns_ + x)];
          box.expand(openvdb::Vec3d(at[0], at[1], at[2]));
        }
      }
    }
    return box;
  }

private:
  std::size_t rows_;
  std::size_t columns_;
  std::vector<std::vector<double>> places_; ///< of the ground, then of each level
};

/// Boxes of leaves round all cells with smoke, counted in leaves.
std::vector<openvdb::CoordBBox> boxes(const geo::LocalFrame& frame, const Levels& levels,
                                      std::span<const float> smoke, double voxel_size) {
  const LevelNodes nodes(frame, levels);
  const std::size_t nx = levels.longitude.size();
  const std::size_t plane = levels.latitude.size() * nx;
  const auto thin = static_cast<float>(thinnest_dilution * fresh_smoke);
  const double side = voxel_size * static_cast<double>(leaf_side);
  const openvdb::Vec3d margin(1.0); // curvature and rounding
  std::vector<openvdb::CoordBBox> result;
  for (std::size_t i = 0; i < smoke.size(); ++i) {
    if (smoke[i] > thin) {
      const openvdb::BBoxd box = nodes.round(i / plane, i % plane / nx, i % nx);
      result.emplace_back(openvdb::Coord::floor((box.min() - margin) / side),
                          openvdb::Coord::floor((box.max() + margin) / side));
    }
  }
  return result;
}

} // namespace

std::vector<openvdb::Coord> reached_leaves(const geo::LocalFrame& frame, const Levels& levels,
                                           std::span<const float> smoke, double voxel_size) {
  openvdb::CoordBBox all;
  const std::vector<openvdb::CoordBBox> parts = boxes(frame, levels, smoke, voxel_size);
  for (const openvdb::CoordBBox& part : parts) {
    all.expand(part);
  }
  if (parts.empty()) {
    return {};
  }
  check_leaf_count(static_cast<double>(all.volume()), voxel_size);
  const openvdb::Coord count = all.dim();
  const auto number = [&](const openvdb::Coord& leaf) {
    const openvdb::Coord place = leaf - all.min();
    return (static_cast<std::size_t>(place.x()) * static_cast<std::size_t>(count.y()) +
            static_cast<std::size_t>(place.y())) *
               static_cast<std::size_t>(count.z()) +
           static_cast<std::size_t>(place.z());
  };
  std::vector<char> hit(all.volume());
  for (const openvdb::CoordBBox& part : parts) {
    for (auto leaf = part.begin(); leaf; ++leaf) {
      hit[number(*leaf)] = 1;
    }
  }
  std::vector<openvdb::Coord> result;
  for (auto leaf = all.begin(); leaf; ++leaf) {
    if (hit[number(*leaf)] != 0) {
      result.push_back(first_voxel(*leaf));
    }
  }
  return result;
}

} // namespace firetwin::volume
