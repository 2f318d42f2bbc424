#include "volume/sunlight.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace firetwin::volume {
namespace {

using Index = std::int64_t;

constexpr double ring =
    0.4; // sine of the elevation that represents the lower four fifths of the sky

/// Memory layout of slices, and the shift of rays between them.
struct Slices {
  Index count, rows, columns;            ///< slices, and voxels of one
  Index next, row, column;               ///< strides in memory
  Index first, sun_direction;            ///< index of the lit slice; +1 or -1 towards the light
  std::size_t along, across_r, across_c; ///< axes
  float row_shift, column_shift;         ///< voxels, from a slice to the previous one
  float half_step;                       ///< m
};

Slices slices(const VoxelGrid& brick, const Vector& direction) {
  const auto length = [&](std::size_t axis) { return std::abs(direction[axis]); };
  const std::size_t along = length(0) >= length(1) && length(0) >= length(2) ? 0
                            : length(1) >= length(2)                         ? 1
                                                                             : 2;
  const std::size_t r = along == 0 ? 1 : 0, c = along == 2 ? 1 : 2;
  const std::array<Index, 3> stride{brick.shape[1] * brick.shape[2], brick.shape[2], 1};
  const double main = length(along);
  const Index sun_direction = direction[along] > 0.0 ? 1 : -1;
  return {brick.shape[along],
          brick.shape[r],
          brick.shape[c],
          stride[along],
          stride[r],
          stride[c],
          sun_direction > 0 ? brick.shape[along] - 1 : 0,
          sun_direction,
          along,
          r,
          c,
          static_cast<float>(direction[r] / main),
          static_cast<float>(direction[c] / main),
          static_cast<float>(0.5 * brick.voxel / main)};
}

/// Interpolation between two voxels of a slice where a ray crosses it. Shifts are at most one
/// voxel.
struct SliceOffset {
  Index low;  ///< offset of the lower neighbour
  float high; ///< weight of the upper neighbour
};

SliceOffset slice_offset(float shift) {
  const float low = std::floor(shift);
  return {static_cast<Index>(low), shift - low};
}

/// Calls f(n) for 0 <= n < count, on many threads.
template <class Function> void each_block(std::size_t count, const Function& f) {
  constexpr std::size_t block = 4096;
  tbb::parallel_for(std::size_t{0}, count, block, [&](std::size_t from) {
    for (std::size_t n = from; n < std::min(from + block, count); ++n) {
      f(n);
    }
  });
}

} // namespace

std::vector<float> optical_depth(const VoxelGrid& smoke, const Vector& direction,
                                 const VoxelGrid* beyond) {
  std::vector<float> depth(smoke.values.size());
  const Slices s = slices(smoke, direction);
  const SliceOffset over_rows = slice_offset(s.row_shift),
                    over_columns = slice_offset(s.column_shift);
  const float* values = smoke.values.data();
  const auto outside = [&](Index slice, Index row, Index column) {
    if (beyond == nullptr) {
      return 0.0F;
    }
    Vector place = smoke.origin;
    place[s.along] += smoke.voxel * static_cast<double>(slice);
    place[s.across_r] += smoke.voxel * static_cast<double>(row);
    place[s.across_c] += smoke.voxel * static_cast<double>(column);
    return sample(*beyond, place);
  };
  for (Index step = 0; step < s.count; ++step) {
    const Index slice = s.first - step * s.sun_direction, before = slice + s.sun_direction;
    tbb::parallel_for(Index{0}, s.rows, [&](Index row) {
      const Index low_row = row + over_rows.low;
      const bool rows_inside = step > 0 && low_row >= 0 && low_row + 1 < s.rows;
      float* out = depth.data() + slice * s.next + row * s.row;
      const float* own = values + slice * s.next + row * s.row;
      for (Index column = 0; column < s.columns; ++column) {
        const Index low = column + over_columns.low;
        float& value = out[column * s.column];
        const float here = own[column * s.column];
        if (!rows_inside || low < 0 || low + 1 >= s.columns) {
          value = outside(slice, row, column) + s.half_step * here;
          continue;
        }
        const Index at = before * s.next + low_row * s.row + low * s.column;
        const auto between = [&](const float* v) {
          const float* a = v + at;
          const float* b = a + s.row;
          const float first = a[0] + (a[s.column] - a[0]) * over_columns.high;
          const float second = b[0] + (b[s.column] - b[0]) * over_columns.high;
          return first + (second - first) * over_rows.high;
        };
        value = between(depth.data()) + s.half_step * (here + between(values));
      }
    });
  }
  return depth;
}

SkyDepths sky_depths(const VoxelGrid& smoke, const SkyDepths* beyond) {
  const double flat = std::sqrt(1.0 - ring * ring);
  const std::array<Vector, sky_directions> ways{
      {{0, 0, 1}, {flat, 0, ring}, {-flat, 0, ring}, {0, flat, ring}, {0, -flat, ring}}};
  SkyDepths found;
  for (std::size_t n = 0; n < ways.size(); ++n) {
    const std::optional<VoxelGrid> outside =
        beyond == nullptr ? std::nullopt : std::optional((*beyond)[n].view());
    found[n] = {optical_depth(smoke, ways[n], outside ? &*outside : nullptr), smoke.shape,
                smoke.voxel, smoke.origin};
  }
  return found;
}

std::vector<float> sky_light(const SkyDepths& depths, double part) {
  std::vector<float> sum(depths[0].values.size());
  const auto log_attenuation = static_cast<float>(-part);
  const float share = 1.0F / static_cast<float>(depths.size());
  for (const OwnedVoxelGrid& depth : depths) {
    each_block(sum.size(), [&](std::size_t n) {
      sum[n] += share * std::exp(log_attenuation * depth.values[n]);
    });
  }
  return sum;
}

} // namespace firetwin::volume
