#include "bins.hpp"

#include "error.hpp"

#include <algorithm>
#include <cmath>

namespace firetwin {
namespace {

constexpr std::size_t kMostLeaves = 100'000'000;

struct Range {
  openvdb::Coord low;
  openvdb::Coord high;
};

Range leaves(const Puffs& puffs, std::size_t ball, float reach, double side) {
  Range range;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double centre = static_cast<double>(puffs.position[3 * ball + axis]);
    const auto at = static_cast<int>(axis);
    range.low[at] = static_cast<int>(std::floor((centre - static_cast<double>(reach)) / side));
    range.high[at] = static_cast<int>(std::floor((centre + static_cast<double>(reach)) / side));
  }
  return range;
}

} // namespace

Bins::Bins(const Puffs& puffs, const std::vector<float>& reach, double voxel_size) {
  const double side = voxel_size * kLeaf;
  openvdb::CoordBBox box;
  for (std::size_t i = 0; i < reach.size(); ++i) {
    if (reach[i] > 0.0F) {
      const Range range = leaves(puffs, i, reach[i], side);
      box.expand(range.low);
      box.expand(range.high);
    }
  }
  if (box.empty()) {
    return;
  }
  low_ = box.min();
  count_ = box.dim();
  const std::size_t total = static_cast<std::size_t>(count_.x()) *
                            static_cast<std::size_t>(count_.y()) *
                            static_cast<std::size_t>(count_.z());
  if (total > kMostLeaves) {
    throw Error("voxels of " + std::to_string(voxel_size) +
                " m are too small for smoke this wide; use larger ones");
  }
  const auto visit = [&](auto&& act) {
    for (std::size_t i = 0; i < reach.size(); ++i) {
      if (reach[i] <= 0.0F) {
        continue;
      }
      const Range range = leaves(puffs, i, reach[i], side);
      for (int x = range.low.x(); x <= range.high.x(); ++x) {
        for (int y = range.low.y(); y <= range.high.y(); ++y) {
          for (int z = range.low.z(); z <= range.high.z(); ++z) {
            const openvdb::Coord at = openvdb::Coord(x, y, z) - low_;
            act(static_cast<std::size_t>((at.x() * count_.y() + at.y())) *
                        static_cast<std::size_t>(count_.z()) +
                    static_cast<std::size_t>(at.z()),
                static_cast<std::uint32_t>(i));
          }
        }
      }
    }
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

openvdb::Coord Bins::origin(std::size_t leaf) const {
  const auto number = static_cast<std::int64_t>(leaf);
  const std::int64_t z = number % count_.z();
  const std::int64_t y = number / count_.z() % count_.y();
  const std::int64_t x = number / count_.z() / count_.y();
  return openvdb::Coord((low_.x() + static_cast<int>(x)) * kLeaf,
                        (low_.y() + static_cast<int>(y)) * kLeaf,
                        (low_.z() + static_cast<int>(z)) * kLeaf);
}

} // namespace firetwin
