#include "volume/bins.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace firetwin::volume {
namespace {

struct Range {
  std::array<std::int32_t, 3> low;
  std::array<std::int32_t, 3> high;
};

Range leaves(const Puffs& puffs, std::size_t ball, float reach, double side) {
  Range range;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double centre = static_cast<double>(puffs.position[3 * ball + axis]);
    range.low[axis] = static_cast<int>(std::floor((centre - static_cast<double>(reach)) / side));
    range.high[axis] = static_cast<int>(std::floor((centre + static_cast<double>(reach)) / side));
  }
  return range;
}

/// The leaves of a box that each ball reaches; none for a ball that does not matter.
std::vector<Range> ranges_in(const LeafBox& box, const Puffs& puffs, std::span<const float> reach,
                             double side) {
  std::vector<Range> ranges(reach.size(), Range{{1, 1, 1}, {0, 0, 0}});
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, reach.size(), 4096), [&](const auto& part) {
    for (std::size_t i = part.begin(); i < part.end(); ++i) {
      if (!(reach[i] > 0.0F)) {
        continue;
      }
      ranges[i] = leaves(puffs, i, reach[i], side);
      for (std::size_t axis = 0; axis < 3; ++axis) { // balls may stick out of the box
        const int first = box.low[static_cast<int>(axis)];
        const int last = first + box.count[static_cast<int>(axis)] - 1;
        ranges[i].low[axis] = std::max(ranges[i].low[axis], first);
        ranges[i].high[axis] = std::min(ranges[i].high[axis], last);
      }
    }
  });
  return ranges;
}

} // namespace

LeafBox::LeafBox(const Puffs& puffs, std::span<const float> reach, double voxel_size)
    : low(0), count(0) {
  const double side = voxel_size * static_cast<double>(leaf_side);
  openvdb::CoordBBox box;
  for (std::size_t i = 0; i < reach.size(); ++i) {
    if (reach[i] > 0.0F) {
      const Range range = leaves(puffs, i, reach[i], side);
      box.expand(openvdb::Coord(range.low[0], range.low[1], range.low[2]));
      box.expand(openvdb::Coord(range.high[0], range.high[1], range.high[2]));
    }
  }
  if (box.empty()) {
    return;
  }
  low = box.min();
  count = box.dim();
  check_leaf_count(size(), voxel_size);
}

std::size_t LeafBox::size() const {
  return static_cast<std::size_t>(count.x()) * static_cast<std::size_t>(count.y()) *
         static_cast<std::size_t>(count.z());
}

openvdb::Coord LeafBox::origin(std::size_t leaf) const {
  const auto number = static_cast<std::int64_t>(leaf);
  const std::int64_t z = number % count.z();
  const std::int64_t y = number / count.z() % count.y();
  const std::int64_t x = number / count.z() / count.y();
  return first_voxel(low.offsetBy(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)));
}

Bins::Bins(const LeafBox& box, const Puffs& puffs, std::span<const float> reach,
           double voxel_size) {
  const double side = voxel_size * static_cast<double>(leaf_side);
  const std::size_t total = box.size();
  const std::vector<Range> ranges = ranges_in(box, puffs, reach, side);
  // Every task has the leaves of some planes to itself and looks through all the balls for them.
  const auto visit = [&](auto&& act) {
    const auto planes = static_cast<std::size_t>(box.count.x());
    const std::size_t grain = std::max<std::size_t>(1, planes / 8);
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, planes, grain),
        [&](const auto& slab) {
          const int first = box.low.x() + static_cast<int>(slab.begin());
          const int last = box.low.x() + static_cast<int>(slab.end()) - 1;
          for (std::size_t i = 0; i < ranges.size(); ++i) {
            const Range& range = ranges[i];
            const int low = std::max(range.low[0], first);
            const int high = std::min(range.high[0], last);
            for (int x = low; x <= high; ++x) {
              for (int y = range.low[1]; y <= range.high[1]; ++y) {
                const auto row = static_cast<std::size_t>(
                    (static_cast<std::int64_t>(x - box.low.x()) * box.count.y() + y - box.low.y()) *
                    box.count.z());
                for (int z = range.low[2]; z <= range.high[2]; ++z) {
                  act(row + static_cast<std::size_t>(z - box.low.z()),
                      static_cast<std::uint32_t>(i));
                }
              }
            }
          }
        },
        tbb::simple_partitioner());
  };
  starts_.assign(total + 1, 0);
  visit([&](std::size_t leaf, std::uint32_t) { ++starts_[leaf + 1]; });
  for (std::size_t i = 0; i < total; ++i) {
    starts_[i + 1] += starts_[i];
  }
  balls_.resize(starts_[total]);
  std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
  visit([&](std::size_t leaf, std::uint32_t ball) { balls_[next[leaf]++] = ball; });
}

} // namespace firetwin::volume
