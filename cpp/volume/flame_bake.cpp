#include "volume/flame_bake.hpp"

#include "volume/archive.hpp"
#include "volume/leaf.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace firetwin::volume {
namespace {

using flames::FlameField;
using flames::FlameLight;
using flames::FlameSamples;
using flames::FlameTiles;
using flames::FlameVolume;

constexpr int leaf_edge = static_cast<int>(leaf_side);
static_assert(lane_count == leaf_side);
constexpr float least_flame = 1.0e-3F; // 1/m, extinction below which a voxel is not active

/// Quantities of flames at eight points, in the order of `sample_flames`: visible and infrared
/// extinction, 1/m, and temperature, K.
using FlamePoints = std::array<Lanes, flame_values>;

/// Samples eight places close together, relative to the flames' origin; false if nothing burns.
bool sample(const FlameVolume& flames, const std::array<Lanes, 3>& place, float fine,
            FlamePoints& found) {
  FlameSamples samples;
  flames.field().evaluate(place[0], place[1], place[2], fine, samples);
  found = FlamePoints{};
  if (!samples.any()) {
    return false;
  }
  bool burns = false;
  const FlameLight& light = flames.light();
  const auto range = static_cast<float>(light.hottest - light.coolest);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const float away = std::hypot(place[0][lane], place[1][lane], place[2][lane]);
    const float part = flames.view().share(away);
    const flames::FlameStep here = flames.step(samples.codes(lane), samples, lane);
    if (here.flames * part > 0.0F) {
      burns = true;
      found[0][lane] = here.flames * part;
      found[1][lane] = here.infrared * part;
      found[2][lane] = static_cast<float>(light.coolest) + range * here.heat;
    }
  }
  return burns;
}

/// Flames on the voxels of a bake.
class FlameVoxels {
public:
  FlameVoxels(const FlameVolume& flames, double voxel_size) : flames_(flames), voxel_(voxel_size) {}

  /// Computes a quantity of a leaf by its first voxel; returns whether something burns.
  bool leaf(const Coord& first, std::size_t quantity, LeafValues& values) const {
    bool burning = false;
    for (int x = 0; x < leaf_edge; ++x) {
      for (int y = 0; y < leaf_edge; ++y) {
        std::array<Lanes, 3> place;
        const std::array<std::int32_t, 3> row{first[0] + x, first[1] + y, first[2]};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (std::size_t lane = 0; lane < lane_count; ++lane) {
            const auto step = static_cast<double>(axis == 2 ? lane : 0);
            place[axis][lane] = static_cast<float>(
                (static_cast<double>(row[axis]) + step) * voxel_ - flames_.origin()[axis]);
          }
        }
        FlamePoints found;
        burning = sample(flames_, place, static_cast<float>(voxel_), found) || burning;
        const auto start = static_cast<std::size_t>((x * leaf_edge + y) * leaf_edge);
        for (std::size_t lane = 0; lane < lane_count; ++lane) {
          const bool burns = found[0][lane] > least_flame;
          values[start + lane] = burns ? found[quantity][lane] : 0.0F;
        }
      }
    }
    return burning;
  }

  /// Adds the leaves with flames above a leaf's column of ground.
  void add_column(int east, int north, Leaves& found) const {
    const auto [low, high] = heights(east, north);
    if (!(low < high)) {
      return;
    }
    const int first = leaf_number(low, voxel_), last = leaf_number(high, voxel_);
    for (int up = first; up <= last; ++up) {
      LeafValues values;
      const Coord origin = first_voxel({east, north, up});
      LeafMask mask;
      if (leaf(origin, 0, values)) {
        for (std::size_t voxel = 0; voxel < leaf_voxels; ++voxel) {
          if (values[voxel] > 0.0F) {
            mask.set(voxel);
          }
        }
      }
      if (!mask.is_empty()) {
        found.add(origin, mask);
      }
    }
  }

private:
  /// Returns the heights, m, between which flames may be above a leaf's column; equal: none.
  std::pair<double, double> heights(int east, int north) const {
    const Vector& origin = flames_.origin();
    float low = 1.0e9F, high = FlameTiles::none;
    for (int x = 0; x <= leaf_edge; ++x) {
      for (int y = 0; y <= leaf_edge; ++y) {
        const auto at = [&](int leaf, int voxel, std::size_t axis) {
          return static_cast<float>((leaf * leaf_edge + voxel) * voxel_ - origin[axis]);
        };
        const float across = at(east, x, 0), along = at(north, y, 1);
        FlameTiles::Tile tile;
        if (!flames_.tiles().find(across, along, tile) || tile.top <= FlameTiles::none) {
          continue;
        }
        const float ground = flames_.tiles().ground_at(across, along);
        if (ground > FlameTiles::none) {
          low = std::min(low, ground - FlameField::below_ground);
          high = std::max(high, tile.top);
        }
      }
    }
    return low < high ? std::pair{low + origin[2], high + origin[2]} : std::pair{0.0, 0.0};
  }

  const FlameVolume& flames_;
  double voxel_;
};

Leaves burning_leaves(const FlameVolume& flames, const FlameVoxels& voxels, double voxel_size) {
  const auto& bounds = flames.tiles().bounds();
  const double reach = static_cast<double>(flames.view().fade[1]);
  std::array<int, 2> low{}, high{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double at = flames.origin()[axis];
    const double from = std::max(static_cast<double>(bounds[2 * axis]), -reach);
    const double to = std::min(static_cast<double>(bounds[2 * axis + 1]), reach);
    low[axis] = leaf_number(at + from, voxel_size);
    high[axis] = leaf_number(at + to, voxel_size) + 1;
  }
  const double columns = std::max(0.0, static_cast<double>(high[0]) - low[0]) *
                         std::max(0.0, static_cast<double>(high[1]) - low[1]);
  check_leaf_count(columns, voxel_size);
  const auto rows = static_cast<std::size_t>(std::max(high[0] - low[0], 0));
  std::vector<Leaves> by_row(rows);
  tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t row) {
    for (int north = low[1]; north < high[1]; ++north) {
      voxels.add_column(low[0] + static_cast<int>(row), north, by_row[row]);
    }
  });
  Leaves all;
  for (const Leaves& row : by_row) {
    for (std::size_t n = 0; n < row.size(); ++n) {
      all.add(row.origins[n], row.masks[n]);
    }
  }
  check_leaf_count(static_cast<double>(all.size()), voxel_size);
  return all;
}

} // namespace

void sample_flames(const FlameVolume& flames, std::span<const double> points, float fine,
                   std::span<float> out) {
  if (points.size() % 3 != 0 || out.size() * 3 != points.size() * flame_values) {
    throw std::invalid_argument("points and the result must be (n, 3)");
  }
  for (std::size_t n = 0; n < points.size() / 3; ++n) {
    std::array<Lanes, 3> place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      place[axis] = Lanes{} + static_cast<float>(points[3 * n + axis] - flames.origin()[axis]);
    }
    FlamePoints found;
    sample(flames, place, fine, found);
    for (std::size_t k = 0; k < flame_values; ++k) {
      out[flame_values * n + k] = found[k][0];
    }
  }
}

VdbSummary write_flames(const std::filesystem::path& path, const FlameVolume& flames,
                        double voxel_size, const io::Metadata& metadata) {
  check_voxel_size(voxel_size);
  const FlameVoxels voxels(flames, voxel_size);
  const Topology topology(flames.tiles().empty() ? Leaves{}
                                                 : burning_leaves(flames, voxels, voxel_size));
  const auto grid = [&](const char* name, const char* units, std::size_t quantity) {
    return FogGrid{
        .name = name,
        .units = units,
        .voxel_size = voxel_size,
        .topology = topology,
        .fill = [&voxels, quantity](const Coord& first, std::size_t, LeafValues& values) {
          voxels.leaf(first, quantity, values);
        }};
  };
  return write_vdb(
      path, {grid("flames", "1/m", 0), grid("infrared", "1/m", 1), grid("temperature", "K", 2)},
      metadata);
}

} // namespace firetwin::volume
