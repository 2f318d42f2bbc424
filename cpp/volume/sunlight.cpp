#include "volume/sunlight.hpp"

#include "base/check.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace firetwin::volume {
namespace {

using Index = std::int64_t;

constexpr double ring = 0.4;  // sine of the middle of four fifths of the sky
constexpr int fine_steps = 4; // as far as the middle of the next voxel but one of twice the size

/// How slices lie in memory, and how the ways to the light cross them.
struct Slices {
  Index count, rows, columns;            ///< slices, and voxels of one
  Index next, row, column;               ///< from one to its neighbour in memory
  Index first, toward;                   ///< the lit slice's number, and +1 or -1 towards the light
  std::size_t along, across_r, across_c; ///< axes
  float row_shift, column_shift;         ///< voxels, from a slice to that before it
  float half_step;                       ///< m
};

Slices slices(const Brick& brick, const Vector& direction) {
  const auto length = [&](std::size_t axis) { return std::abs(direction[axis]); };
  const std::size_t along = length(0) >= length(1) && length(0) >= length(2) ? 0
                            : length(1) >= length(2)                         ? 1
                                                                             : 2;
  const std::size_t r = along == 0 ? 1 : 0, c = along == 2 ? 1 : 2;
  const std::array<Index, 3> stride{brick.shape[1] * brick.shape[2], brick.shape[2], 1};
  const double main = length(along);
  const Index toward = direction[along] > 0.0 ? 1 : -1;
  return {brick.shape[along],
          brick.shape[r],
          brick.shape[c],
          stride[along],
          stride[r],
          stride[c],
          toward > 0 ? brick.shape[along] - 1 : 0,
          toward,
          along,
          r,
          c,
          static_cast<float>(direction[r] / main),
          static_cast<float>(direction[c] / main),
          static_cast<float>(0.5 * brick.voxel / main)};
}

/// Between neighbours of a slice, where a way crosses it. Shifts are of at most one voxel.
struct Crossing {
  Index low;  ///< the lower neighbour's offset
  float high; ///< weight of the upper
};

Crossing crossing(float shift) {
  const float low = std::floor(shift);
  return {static_cast<Index>(low), shift - low};
}

void check_direction(const Vector& direction) {
  check_finite(direction, "direction");
  if (std::abs(std::sqrt(dot(direction, direction)) - 1.0) > 1.0e-6) {
    throw std::invalid_argument("direction must be a unit vector");
  }
}

/// f(n) for 0 <= n < count, on many threads.
template <class Function> void each_block(std::size_t count, const Function& f) {
  constexpr std::size_t block = 4096;
  tbb::parallel_for(std::size_t{0}, count, block, [&](std::size_t from) {
    for (std::size_t n = from; n < std::min(from + block, count); ++n) {
      f(n);
    }
  });
}

/// What is summed round a voxel, the same round each: places in memory, and their weights.
struct Stencil {
  std::vector<Index> offsets;
  std::vector<float> weights;
  std::array<Index, 3> low{}, high{}; ///< how far it reaches, voxels
};

/// The mean of smoke along the first `fine_steps` voxels of the way, linear between voxels.
Stencil first_steps(const Brick& smoke, const Vector& direction) {
  std::map<std::array<Index, 3>, double> weights;
  for (int step = 0; step < fine_steps; ++step) {
    for (unsigned corner = 0; corner < 8; ++corner) {
      std::array<Index, 3> at{};
      double weight = 1.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double moved = (step + 0.5) * direction[axis], low = std::floor(moved);
        const bool high = (corner >> axis & 1U) != 0;
        at[axis] = static_cast<Index>(low) + (high ? 1 : 0);
        weight *= high ? moved - low : 1.0 - (moved - low);
      }
      if (weight > 0.0) {
        weights[at] += weight;
      }
    }
  }
  Stencil found;
  for (const auto& [at, weight] : weights) {
    found.offsets.push_back((at[0] * smoke.shape[1] + at[1]) * smoke.shape[2] + at[2]);
    found.weights.push_back(static_cast<float>(weight));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      found.low[axis] = std::min(found.low[axis], at[axis]);
      found.high[axis] = std::max(found.high[axis], at[axis]);
    }
  }
  return found;
}

/// Optical depth from the middles of voxels to a light far away, see `lit`.
std::vector<float> optical_depth(const Brick& smoke, const Vector& direction, const Brick* beyond) {
  std::vector<float> depth(smoke.values.size());
  const Slices s = slices(smoke, direction);
  const Crossing over_rows = crossing(s.row_shift), over_columns = crossing(s.column_shift);
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
    const Index slice = s.first - step * s.toward, before = slice + s.toward;
    tbb::parallel_for(Index{0}, s.rows, [&](Index row) {
      const Index low_row = row + over_rows.low;
      const bool rows_inside = step > 0 && low_row >= 0 && low_row + 1 < s.rows;
      float* out = depth.data() + slice * s.next + row * s.row;
      const float* own = values + slice * s.next + row * s.row;
      for (Index column = 0; column < s.columns; ++column) {
        const Index low = column + over_columns.low;
        float& found = out[column * s.column];
        const float here = own[column * s.column];
        if (!rows_inside || low < 0 || low + 1 >= s.columns) {
          found = outside(slice, row, column) + s.half_step * here;
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
        found = between(depth.data()) + s.half_step * (here + between(values));
      }
    });
  }
  return depth;
}

/// Mean of exp(-part * depth) over five ways up.
std::vector<float> sky_light(const Brick& smoke, double part) {
  const double flat = std::sqrt(1.0 - ring * ring);
  const std::array<Vector, 5> ways{
      {{0, 0, 1}, {flat, 0, ring}, {-flat, 0, ring}, {0, flat, ring}, {0, -flat, ring}}};
  std::vector<float> sum(smoke.values.size());
  const auto thinner = static_cast<float>(-part);
  const float share = 1.0F / static_cast<float>(ways.size());
  for (const Vector& way : ways) {
    const std::vector<float> depth = optical_depth(smoke, way, nullptr);
    each_block(sum.size(), [&](std::size_t n) { sum[n] += share * std::exp(thinner * depth[n]); });
  }
  return sum;
}

} // namespace

OwnBrick lit(const Brick& smoke, const Vector& direction, const Brick* beyond,
             std::array<double, 2> parts, const Light& light) {
  check(smoke);
  if (light.sun.size() != smoke.values.size() || light.sky.size() != smoke.values.size()) {
    throw std::invalid_argument("arrays of light and smoke must have the brick's shape");
  }
  check_direction(direction);
  OwnBrick depth = halved(smoke), open = halved(depth.view());
  open.values = sky_light(open.view(), parts[1]);
  depth.values = optical_depth(depth.view(), direction, beyond);
  const Brick depths = depth.view(), sky = open.view();
  const auto near = near_smoke(smoke);
  const Stencil first = first_steps(smoke, direction);
  const auto fits = [&](std::size_t axis, Index at) {
    return at + first.low[axis] >= 0 && at + first.high[axis] < smoke.shape[axis];
  };
  const auto thinner = static_cast<float>(-parts[0]), step = static_cast<float>(smoke.voxel);
  tbb::parallel_for(Index{0}, smoke.shape[0], [&](Index i) {
    for (Index j = 0; j < smoke.shape[1]; ++j) {
      const Index row = (i * smoke.shape[1] + j) * smoke.shape[2];
      const bool row_fits = fits(0, i) && fits(1, j);
      for (Index k = 0; k < smoke.shape[2]; ++k) {
        const auto n = static_cast<std::size_t>(row + k);
        if (near[n] == 0) {
          continue;
        }
        const Vector place{smoke.origin[0] + smoke.voxel * static_cast<double>(i),
                           smoke.origin[1] + smoke.voxel * static_cast<double>(j),
                           smoke.origin[2] + smoke.voxel * static_cast<double>(k)};
        const bool fine = row_fits && fits(2, k); // else at the brick's side, where smoke ends
        Vector on = place;
        float sum = 0.0F;
        if (fine) {
          const float* own = smoke.values.data() + row + k;
          for (std::size_t m = 0; m < first.weights.size(); ++m) {
            sum += first.weights[m] * own[first.offsets[m]];
          }
          for (std::size_t axis = 0; axis < 3; ++axis) {
            on[axis] += fine_steps * smoke.voxel * direction[axis];
          }
        }
        light.sun[n] = std::exp(thinner * (sum * step + sample(depths, on)));
        light.sky[n] = sample(sky, place);
      }
    }
  });
  return depth;
}

} // namespace firetwin::volume
