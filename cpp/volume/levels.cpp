#include "volume/levels.hpp"

#include "base/error.hpp"
#include "base/smoothstep.hpp"
#include "volume/level_leaves.hpp"
#include "volume/level_sampler.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace firetwin::volume {
namespace {

constexpr double thick_dilution = 0.1;

struct SampledLeaf {
  Coord origin;
  LeafMask mask;
  LeafValues concentration{};
  LeafValues temperature{};
};

void check_heights(const Levels& levels) {
  const std::size_t plane = levels.latitude.size() * levels.longitude.size();
  const auto is_wrong = [&](std::size_t i) {
    const float height = levels.height[i];
    return !std::isfinite(height) || (i >= plane && height <= levels.height[i - plane]);
  };
  using Range = tbb::blocked_range<std::size_t>;
  const std::size_t wrong = tbb::parallel_reduce(
      Range(0, levels.height.size(), 1 << 16), levels.height.size(),
      [&](const Range& range, std::size_t found) {
        for (std::size_t i = range.begin(); i < std::min(range.end(), found); ++i) {
          found = is_wrong(i) ? i : found;
        }
        return found;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
  if (wrong < levels.height.size()) {
    throw Error("height_3d: heights must be finite and ascend with the levels, but level " +
                std::to_string(wrong / plane) + " of cell " + std::to_string(wrong % plane) +
                " is at " + std::to_string(levels.height[wrong]) + " m");
  }
}

/// Geodetic positions of a leaf's voxels, interpolated from its corners.
class LeafPlaces {
public:
  /// Longitudes are unwrapped to within 180 degrees of `middle`.
  LeafPlaces(const geo::LocalFrame& frame, const Coord& origin, double voxel_size, double middle) {
    std::array<double, 24> enu{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto step = static_cast<double>((corner >> (2 - axis) & 1) * (leaf_side - 1));
        enu[3 * corner + axis] = (origin[axis] + step) * voxel_size;
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

  /// Returns the lowest and the highest voxel of a row along z.
  std::array<LevelSampler::Place, 2> row(std::size_t x, std::size_t y) const {
    const double east = static_cast<double>(x) / 7.0;
    const double north = static_cast<double>(y) / 7.0;
    const std::array<double, 4> weights{(1.0 - east) * (1.0 - north), (1.0 - east) * north,
                                        east * (1.0 - north), east * north};
    std::array<LevelSampler::Place, 2> ends{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ends[corner % 2][axis] += weights[corner / 2] * corners_[corner][axis];
      }
    }
    return ends;
  }

private:
  std::array<LevelSampler::Place, 8> corners_{};
};

std::unique_ptr<SampledLeaf> sample(const geo::LocalFrame& frame, const Levels& levels,
                                    const Coord& origin, double voxel_size) {
  auto leaf = std::make_unique<SampledLeaf>();
  leaf->origin = origin;
  const double middle = 0.5 * (levels.longitude.front() + levels.longitude.back());
  const LeafPlaces places(frame, origin, voxel_size, middle);
  LevelSampler sampler(levels);
  for (std::size_t i = 0; i < leaf_voxels; i += leaf_side) {
    const auto [low, high] = places.row(i / 64, i / 8 % 8);
    for (std::size_t z = 0; z < leaf_side; ++z) {
      LevelSampler::Place place{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        place[axis] = low[axis] + static_cast<double>(z) / 7.0 * (high[axis] - low[axis]);
      }
      if (!sampler.move(place)) {
        continue;
      }
      const double found = sampler.smoke();
      if (found <= min_dilution * fresh_smoke) {
        continue;
      }
      const double kelvin = levels.temperature.empty()
                                ? static_cast<double>(air_kelvin(static_cast<float>(place[2])))
                                : sampler.temperature();
      leaf->mask.set(i + z);
      leaf->concentration[i + z] = static_cast<float>(found);
      leaf->temperature[i + z] = std::clamp(
          std::isfinite(kelvin) ? static_cast<float>(kelvin) : 0.0F, 0.0F, max_temperature);
    }
  }
  return leaf->mask.is_empty() ? nullptr : std::move(leaf);
}

void fill(const SampledLeaf& leaf, SmokeGrid grid, float size, LeafValues& out) {
  if (grid == SmokeGrid::size || grid == SmokeGrid::temperature) {
    out = leaf.temperature;
    if (grid == SmokeGrid::size) {
      out.fill(size);
    }
    return;
  }
  for (std::size_t i = 0; i < leaf_voxels; ++i) {
    const float dilution = leaf.concentration[i] / static_cast<float>(fresh_smoke);
    const float density =
        smoothstep(static_cast<float>(min_dilution), static_cast<float>(thick_dilution), dilution);
    out[i] = grid == SmokeGrid::density ? density : dilution;
    if (grid == SmokeGrid::shade) {
      out[i] *= smoothstep(edge_low, edge_high, density);
    }
  }
}

/// Returns the column spacing at the centre of the grid, km.
float spacing(const geo::LocalFrame& frame, const Levels& levels) {
  const std::size_t row = (levels.latitude.size() - 1) / 2;
  const std::size_t column = (levels.longitude.size() - 1) / 2;
  const std::size_t next = std::min(column + 1, levels.longitude.size() - 1);
  const auto from = frame.forward(levels.latitude[row], levels.longitude[column], 0.0);
  const auto to = frame.forward(levels.latitude[row], levels.longitude[next], 0.0);
  return static_cast<float>(std::hypot(to[0] - from[0], to[1] - from[1]) / 1000.0);
}

} // namespace

VdbSummary write_levels(const std::filesystem::path& path, const geo::LocalFrame& frame,
                        const Levels& levels, double voxel_size, const GridRequest& wanted) {
  check_voxel_size(voxel_size);
  check_heights(levels);
  const std::vector<Coord> origins = reached_leaves(frame, levels, voxel_size);
  std::vector<std::unique_ptr<SampledLeaf>> all(origins.size());
  tbb::parallel_for(std::size_t{0}, origins.size(),
                    [&](std::size_t i) { all[i] = sample(frame, levels, origins[i], voxel_size); });
  std::erase(all, nullptr);
  LeafSource source;
  source.density_units = "smoothstep of dilution";
  for (const auto& leaf : all) {
    source.leaves.add(leaf->origin, leaf->mask);
  }
  const float size = std::min(spacing(frame, levels), 1.0F);
  source.values = [&](std::size_t leaf, SmokeGrid grid, LeafValues& out) {
    fill(*all[leaf], grid, size, out);
  };
  return write_leaves(path, source, voxel_size, wanted);
}

} // namespace firetwin::volume
