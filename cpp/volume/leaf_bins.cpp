#include "volume/leaf_bins.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

namespace firetwin::volume {
namespace {

/// Concatenates lists of numbers in two passes (count, then fill). `visit` calls its argument with
/// pairs of list and number, in both passes with the same pairs.
template <class Visit>
void make_lists(std::size_t count, const Visit& visit, std::vector<std::size_t>& starts,
                std::vector<std::uint32_t>& numbers) {
  starts.assign(count + 1, 0);
  visit([&](std::size_t list, std::uint32_t) { ++starts[list + 1]; });
  for (std::size_t i = 0; i < count; ++i) {
    starts[i + 1] += starts[i];
  }
  numbers.resize(starts[count]);
  std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
  visit([&](std::size_t list, std::uint32_t number) { numbers[next[list]++] = number; });
}

} // namespace

LeafBox::LeafBox(const Puffs& puffs, std::span<const float> reach, double voxel_size) {
  CoordBox box;
  for (std::size_t i = 0; i < reach.size(); ++i) {
    for (int way = -1; way <= 1 && reach[i] > 0.0F; way += 2) {
      Coord end;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        end[axis] = leaf_number(static_cast<double>(puffs.position[3 * i + axis]) +
                                    way * static_cast<double>(reach[i]),
                                voxel_size);
      }
      box.expand(end);
    }
  }
  if (box.is_empty()) {
    return;
  }
  low = box.low;
  count = {box.size(0), box.size(1), box.size(2)};
  check_leaf_count(static_cast<double>(count.x()) * static_cast<double>(count.y()) *
                       static_cast<double>(count.z()),
                   voxel_size);
}

std::size_t LeafBox::leaves_in_plane() const {
  return static_cast<std::size_t>(count.y()) * static_cast<std::size_t>(count.z());
}

Coord LeafBox::origin(std::size_t plane, std::size_t leaf) const {
  const auto x = static_cast<int>(plane);
  const auto number = static_cast<int>(leaf);
  return first_voxel(low.offset(x, number / count.z(), number % count.z()));
}

LeafBins::LeafBins(const LeafBox& box, const Puffs& puffs, std::span<const float> reach,
                   double voxel_size)
    : box_(box), ranges_(reach.size(), Range{{1, 1, 1}, {0, 0, 0}}) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, reach.size(), 4096), [&](const auto& part) {
    for (std::size_t i = part.begin(); i < part.end(); ++i) {
      for (std::size_t axis = 0; axis < 3 && reach[i] > 0.0F; ++axis) {
        const double centre = static_cast<double>(puffs.position[3 * i + axis]);
        const auto far = static_cast<double>(reach[i]);
        const int first = box.low[axis];
        const int last = first + box.count[axis] - 1;
        ranges_[i].low[axis] = std::max(leaf_number(centre - far, voxel_size), first) - first;
        ranges_[i].high[axis] = std::min(leaf_number(centre + far, voxel_size), last) - first;
      }
    }
  });
  make_lists(
      box.planes(),
      [&](auto&& add) {
        for (std::size_t i = 0; i < ranges_.size(); ++i) {
          for (int x = ranges_[i].low[0]; x <= ranges_[i].high[0]; ++x) {
            add(static_cast<std::size_t>(x), static_cast<std::uint32_t>(i));
          }
        }
      },
      starts_, crossing_);
}

LeafBins::Plane::Plane(const LeafBins& bins, std::size_t plane) {
  const LeafBox& box = bins.box_;
  const std::span<const std::uint32_t> crossing{bins.crossing_.data() + bins.starts_[plane],
                                                bins.crossing_.data() + bins.starts_[plane + 1]};
  make_lists(
      box.leaves_in_plane(),
      [&](auto&& add) {
        for (const std::uint32_t ball : crossing) {
          const Range& range = bins.ranges_[ball];
          for (int y = range.low[1]; y <= range.high[1]; ++y) {
            for (int z = range.low[2]; z <= range.high[2]; ++z) {
              add(static_cast<std::size_t>(std::int64_t{y} * box.count.z() + z), ball);
            }
          }
        }
      },
      starts_, balls_);
}

} // namespace firetwin::volume
