#include "levels.hpp"

#include "archive.hpp"
#include "error.hpp"
#include "geo/axis.hpp"
#include "grids.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace firetwin {
namespace {

constexpr std::size_t kMostLeaves = 100'000'000;

using Place = std::array<double, 3>; // latitude, longitude, height

struct Leaf {
  openvdb::Coord origin;
  LeafMask mask;
  LeafValues concentration{};
  LeafValues temperature{};
};

/// Reads fields at any place. Keeps where it found the last one, for neighbours lie near.
class Sampler {
public:
  explicit Sampler(const Levels& levels)
      : levels_(levels), columns_(levels.longitude.size()),
        plane_(levels.latitude.size() * levels.longitude.size()) {}

  /// Moves to a place; false where there is no smoke to be found.
  bool move(const Place& place) {
    if (!inside(levels_.latitude, place[0]) || !inside(levels_.longitude, place[1])) {
      return false;
    }
    const geo::Bracket row = geo::bracket(levels_.latitude, place[0]);
    const geo::Bracket column = geo::bracket(levels_.longitude, place[1]);
    cells_ = {row.lower * columns_ + column.lower, row.lower * columns_ + column.upper,
              row.upper * columns_ + column.lower, row.upper * columns_ + column.upper};
    weights_ = {(1.0 - row.fraction) * (1.0 - column.fraction),
                (1.0 - row.fraction) * column.fraction, row.fraction * (1.0 - column.fraction),
                row.fraction * column.fraction};
    return find_level(place[2]);
  }

  double value(std::span<const float> field) const {
    const double low = level_value(field, level_);
    return low + part_ * (level_value(field, level_ + 1) - low);
  }

private:
  static bool inside(std::span<const double> axis, double value) {
    return value >= std::min(axis.front(), axis.back()) &&
           value <= std::max(axis.front(), axis.back());
  }

  double level_value(std::span<const float> field, std::size_t level) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      sum += weights_[i] * static_cast<double>(field[level * plane_ + cells_[i]]);
    }
    return sum;
  }

  bool find_level(double height) {
    while (level_ > 0 && height < level_value(levels_.height, level_)) {
      --level_;
    }
    while (level_ + 2 < levels_.levels && height >= level_value(levels_.height, level_ + 1)) {
      ++level_;
    }
    const double low = level_value(levels_.height, level_);
    const double high = level_value(levels_.height, level_ + 1);
    if (height > high || height < level_value(levels_.ground, 0)) {
      return false;
    }
    part_ = height < low ? 0.0 : (height - low) / (high - low);
    return true;
  }

  const Levels& levels_;
  std::size_t columns_;
  std::size_t plane_;
  std::array<std::size_t, 4> cells_{};
  std::array<double, 4> weights_{};
  std::size_t level_ = 0;
  double part_ = 0.0;
};

void check_heights(const Levels& levels) {
  const std::size_t plane = levels.latitude.size() * levels.longitude.size();
  for (std::size_t i = 0; i < levels.height.size(); ++i) {
    const float height = levels.height[i];
    if (!std::isfinite(height) || (i >= plane && height <= levels.height[i - plane])) {
      throw Error("height_3d: the heights of the levels must be numbers and ascend; level " +
                  std::to_string(i / plane) + " of cell " + std::to_string(i % plane) + " is at " +
                  std::to_string(height) + " m");
    }
  }
}

/// Smoke without gaps: what is no number or negative becomes 0.
std::vector<float> clean(std::span<const float> smoke) {
  std::vector<float> result(smoke.size());
  std::transform(smoke.begin(), smoke.end(), result.begin(),
                 [](float v) { return v > 0.0F && std::isfinite(v) ? v : 0.0F; });
  return result;
}

/// Leaves that cells with smoke may reach, in voxels from a multiple of 8.
std::vector<openvdb::Coord> reached(const geo::LocalFrame& frame, const Levels& levels,
                                    std::span<const float> smoke, double voxel_size) {
  const std::size_t ny = levels.latitude.size();
  const std::size_t nx = levels.longitude.size();
  const std::size_t plane = ny * nx;
  const auto thin = static_cast<float>(kThinnest * kFreshSmoke);
  // The lowest smoke goes on to the ground: a level of its own.
  std::vector<double> height(plane);
  std::vector<std::vector<double>> places(levels.levels + 1, std::vector<double>(3 * plane));
  for (std::size_t level = 0; level <= levels.levels; ++level) {
    const std::span<const float> from =
        level == 0 ? levels.ground : levels.height.subspan((level - 1) * plane, plane);
    std::copy(from.begin(), from.end(), height.begin());
    frame.forward_grid(levels.latitude, levels.longitude, height, places[level]);
  }
  const double side = voxel_size * static_cast<double>(kLeafSide);
  std::vector<openvdb::CoordBBox> boxes;
  openvdb::CoordBBox all;
  for (std::size_t i = 0; i < smoke.size(); ++i) {
    if (smoke[i] <= thin) {
      continue;
    }
    const std::size_t level = i / plane;
    const std::size_t row = i % plane / nx;
    const std::size_t column = i % nx;
    openvdb::BBoxd box;
    for (std::size_t k = level; k <= std::min(level + 2, levels.levels); ++k) {
      for (std::size_t y = row > 0 ? row - 1 : 0; y <= std::min(row + 1, ny - 1); ++y) {
        for (std::size_t x = column > 0 ? column - 1 : 0; x <= std::min(column + 1, nx - 1); ++x) {
          const double* at = &places[k][3 * (y * nx + x)];
          box.expand(openvdb::Vec3d(at[0], at[1], at[2]));
        }
      }
    }
    const openvdb::Vec3d margin(1.0); // curvature and rounding
    boxes.emplace_back(openvdb::Coord::floor((box.min() - margin) / side),
                       openvdb::Coord::floor((box.max() + margin) / side));
    all.expand(boxes.back());
  }
  if (boxes.empty()) {
    return {};
  }
  const openvdb::Coord count = all.dim();
  const auto at = [&](int x, int y, int z) {
    return (static_cast<std::size_t>(x) * static_cast<std::size_t>(count.y()) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(count.z()) +
           static_cast<std::size_t>(z);
  };
  if (all.volume() > kMostLeaves) {
    throw Error("voxels of " + std::to_string(voxel_size) +
                " m are too small for smoke this wide; use larger ones");
  }
  std::vector<char> hit(all.volume());
  for (const openvdb::CoordBBox& box : boxes) {
    for (auto leaf = box.begin(); leaf; ++leaf) {
      const openvdb::Coord place = *leaf - all.min();
      hit[at(place.x(), place.y(), place.z())] = 1;
    }
  }
  std::vector<openvdb::Coord> result;
  for (auto leaf = all.begin(); leaf; ++leaf) {
    const openvdb::Coord place = *leaf - all.min();
    if (hit[at(place.x(), place.y(), place.z())] != 0) {
      result.push_back(openvdb::Coord((*leaf).x() * 8, (*leaf).y() * 8, (*leaf).z() * 8));
    }
  }
  return result;
}

/// Geodetic place of every voxel of a leaf from those of its corners.
class LeafPlaces {
public:
  /// Longitudes are counted as near `middle` as can be.
  LeafPlaces(const geo::LocalFrame& frame, const openvdb::Coord& origin, double voxel_size,
             double middle) {
    std::array<double, 24> enu{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto step = static_cast<double>((corner >> (2 - axis) & 1) * (kLeafSide - 1));
        enu[3 * corner + axis] = (origin[static_cast<int>(axis)] + step) * voxel_size;
      }
    }
    std::array<std::array<double, 8>, 3> found{};
    frame.reverse(enu, found[0], found[1], found[2]);
    for (std::size_t corner = 0; corner < 8; ++corner) {
      corners_[corner] = {found[0][corner],
                          middle + std::remainder(found[1][corner] - middle, 360.0),
                          found[2][corner]};
    }
  }

  Place at(std::size_t x, std::size_t y, std::size_t z) const {
    const std::array<double, 3> part{static_cast<double>(x) / 7.0, static_cast<double>(y) / 7.0,
                                     static_cast<double>(z) / 7.0};
    Place place{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
      double weight = 1.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        weight *= (corner >> (2 - axis) & 1) != 0 ? part[axis] : 1.0 - part[axis];
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        place[axis] += weight * corners_[corner][axis];
      }
    }
    return place;
  }

private:
  std::array<Place, 8> corners_{};
};

std::unique_ptr<Leaf> sample(const geo::LocalFrame& frame, const Levels& levels,
                             std::span<const float> smoke, const openvdb::Coord& origin,
                             double voxel_size) {
  auto leaf = std::make_unique<Leaf>();
  leaf->origin = origin;
  const double middle = 0.5 * (levels.longitude.front() + levels.longitude.back());
  const LeafPlaces places(frame, origin, voxel_size, middle);
  Sampler sampler(levels);
  for (openvdb::Index i = 0; i < kLeafVoxels; ++i) {
    const Place place = places.at(i / 64, i / 8 % 8, i % 8);
    if (!sampler.move(place)) {
      continue;
    }
    const double found = sampler.value(smoke);
    if (found <= kThinnest * kFreshSmoke) {
      continue;
    }
    leaf->mask.setOn(i);
    leaf->concentration[i] = static_cast<float>(found);
    const double kelvin = levels.temperature.empty()
                              ? static_cast<double>(air_kelvin(static_cast<float>(place[2])))
                              : sampler.value(levels.temperature);
    leaf->temperature[i] =
        std::clamp(std::isfinite(kelvin) ? static_cast<float>(kelvin) : 0.0F, 0.0F, kHottest);
  }
  return leaf->mask.isOff() ? nullptr : std::move(leaf);
}

void fill(const Leaf& leaf, SmokeGrid grid, float size, LeafValues& out) {
  if (grid == SmokeGrid::size || grid == SmokeGrid::temperature) {
    out = leaf.temperature;
    if (grid == SmokeGrid::size) {
      out.fill(size);
    }
    return;
  }
  for (std::size_t i = 0; i < kLeafVoxels; ++i) {
    const float dilution = leaf.concentration[i] / static_cast<float>(kFreshSmoke);
    const float density =
        smoothstep(static_cast<float>(kThinnest), static_cast<float>(kThick), dilution);
    out[i] = grid == SmokeGrid::density ? density : dilution;
    if (grid == SmokeGrid::shade) {
      out[i] *= smoothstep(kEdgeLow, kEdgeHigh, density);
    }
  }
}

/// Spacing of the columns in the middle of the grid, km.
float spacing(const geo::LocalFrame& frame, const Levels& levels) {
  const std::size_t row = (levels.latitude.size() - 1) / 2;
  const std::size_t column = (levels.longitude.size() - 1) / 2;
  const std::size_t next = std::min(column + 1, levels.longitude.size() - 1);
  const auto from = frame.forward(levels.latitude[row], levels.longitude[column], 0.0);
  const auto to = frame.forward(levels.latitude[row], levels.longitude[next], 0.0);
  return static_cast<float>(std::hypot(to[0] - from[0], to[1] - from[1]) / 1000.0);
}

} // namespace

VolumeFrame write_levels(const std::string& path, const geo::LocalFrame& frame,
                         const Levels& levels, double voxel_size, const Wanted& wanted) {
  fog_grid("check", voxel_size, {0.0, 0.0, 0.0}, ""); // reports a bad voxel size
  check_heights(levels);
  const std::vector<float> smoke = clean(levels.smoke);
  const std::vector<openvdb::Coord> origins = reached(frame, levels, smoke, voxel_size);
  std::vector<std::unique_ptr<Leaf>> all(origins.size());
  tbb::parallel_for(std::size_t{0}, origins.size(), [&](std::size_t i) {
    all[i] = sample(frame, levels, smoke, origins[i], voxel_size);
  });
  std::erase(all, nullptr);
  LeafSource source;
  source.density_units = "smoothstep of dilution";
  for (const auto& leaf : all) {
    source.leaves.origins.push_back(leaf->origin);
    source.leaves.masks.push_back(leaf->mask);
  }
  const float size = std::min(spacing(frame, levels), 1.0F);
  source.values = [&](std::size_t leaf, SmokeGrid grid, LeafValues& out) {
    fill(*all[leaf], grid, size, out);
  };
  return write_leaves(path, source, voxel_size, wanted);
}

} // namespace firetwin
