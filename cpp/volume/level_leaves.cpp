#include "volume/level_leaves.hpp"

#include "base/vector.hpp"
#include "volume/grids.hpp"
#include "volume/leaf.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <span>

namespace firetwin::volume {
namespace {

constexpr std::size_t rows_in_band = 16;

/// Set of leaves, in leaf coordinates: a mask for each block of 8^3 leaves.
class LeafSet {
public:
  explicit LeafSet(double voxel_size) : voxel_size_(voxel_size) {}

  void add(const CoordBox& box) {
    if (last_.contains(box)) {
      return; // for cells smaller than leaves
    }
    const double added =
        static_cast<double>(box.size(0)) * static_cast<double>(box.size(1)) * box.size(2);
    check_leaf_count(added, voxel_size_);
    fill(box);
    last_ = box;
    unchecked_ += added;
    if (unchecked_ > 1.0e7) {
      check();
      unchecked_ = 0.0;
    }
  }

  void take(LeafSet& other) {
    for (const auto& [block, mask] : other.blocks_) {
      LeafMask& all = blocks_[block];
      for (std::size_t i = 0; i < all.words.size(); ++i) {
        all.words[i] |= mask.words[i];
      }
    }
    other.blocks_.clear();
    check();
  }

  std::vector<Coord> first_voxels() const {
    std::vector<Coord> result;
    result.reserve(count());
    for (const auto& [block, mask] : blocks_) {
      const Coord first = first_voxel(block);
      mask.each([&](std::size_t i) {
        const auto leaf = static_cast<std::int32_t>(i);
        result.push_back(
            first_voxel(first.offset(leaf / side / side, leaf / side % side, leaf % side)));
      });
    }
    tbb::parallel_sort(result.begin(), result.end());
    return result;
  }

private:
  static constexpr auto side = static_cast<std::int32_t>(leaf_side);

  void fill(const CoordBox& box) {
    constexpr int shift = std::countr_zero(leaf_side); // rounds down, unlike a division
    for (std::int32_t x = box.low.x() >> shift; x <= box.high.x() >> shift; ++x) {
      for (std::int32_t y = box.low.y() >> shift; y <= box.high.y() >> shift; ++y) {
        for (std::int32_t z = box.low.z() >> shift; z <= box.high.z() >> shift; ++z) {
          const Coord block(x, y, z);
          fill(box, first_voxel(block), blocks_[block]);
        }
      }
    }
  }

  /// Adds the leaves in the box to the mask of the block whose first leaf is `first`.
  static void fill(const CoordBox& box, const Coord& first, LeafMask& mask) {
    Coord low;
    Coord high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::max(box.low[axis] - first[axis], 0);
      high[axis] = std::min(box.high[axis] - first[axis], side - 1);
    }
    const std::uint64_t row = (0xffU >> (side - 1 - high.z() + low.z())) << low.z();
    for (std::int32_t x = low.x(); x <= high.x(); ++x) {
      for (std::int32_t y = low.y(); y <= high.y(); ++y) {
        mask.words[static_cast<std::size_t>(x)] |= row << (side * y);
      }
    }
  }

  std::size_t count() const {
    std::size_t leaves = 0;
    for (const auto& [block, mask] : blocks_) {
      for (const std::uint64_t word : mask.words) {
        leaves += static_cast<std::size_t>(std::popcount(word));
      }
    }
    return leaves;
  }

  void check() const { check_leaf_count(static_cast<double>(count()), voxel_size_); }

  double voxel_size_;
  std::map<Coord, LeafMask> blocks_;
  CoordBox last_;          ///< last box added
  double unchecked_ = 0.0; ///< leaves added since the last check, with duplicates
};

/// Some rows of cells between two consecutive levels, or between the ground and the lowest level,
/// whose smoke reaches down to the ground.
class Band {
public:
  /// @param layer 0: from the ground to level 0; n: from level n - 1 to level n
  Band(const geo::LocalFrame& frame, const Levels& levels, std::size_t layer, std::size_t first,
       std::size_t last)
      : frame_(frame), levels_(levels), columns_(levels.longitude.size()), layer_(layer),
        first_(first), rows_(last - first + 1) {}

  /// Adds the leaves around each cell that has smoke at a corner.
  void reach(double voxel_size, LeafSet& leaves) const {
    if (!has_smoke()) {
      return;
    }
    const std::vector<double> low = nodes(layer_);
    const std::vector<double> high = nodes(layer_ + 1);
    for (std::size_t y = 0; y + 1 < rows_; ++y) {
      for (std::size_t x = 0; x + 1 < columns_; ++x) {
        if (is_smoke(y, x)) {
          Bounds box;
          for (const std::size_t i : corners(y, x)) {
            box.expand(&low[3 * i]);
            box.expand(&high[3 * i]);
          }
          leaves.add(leaves_around(box, voxel_size));
        }
      }
    }
  }

private:
  /// Bounding box of points, m.
  struct Bounds {
    static constexpr double largest = std::numeric_limits<double>::max();
    Vector low{largest, largest, largest};
    Vector high{-largest, -largest, -largest};

    void expand(const double* point) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], point[axis]);
        high[axis] = std::max(high[axis], point[axis]);
      }
    }
  };

  std::array<std::size_t, 4> corners(std::size_t y, std::size_t x) const {
    const std::size_t i = y * columns_ + x;
    return {i, i + 1, i + columns_, i + columns_ + 1};
  }

  /// Returns a field's values at the nodes of the band on one level.
  std::span<const float> rows(std::span<const float> field, std::size_t level) const {
    const std::size_t plane = levels_.latitude.size() * columns_;
    return field.subspan(level * plane + first_ * columns_, rows_ * columns_);
  }

  static bool is_thick(float smoke) {
    return valid_smoke(smoke) > static_cast<float>(min_dilution * fresh_smoke);
  }

  bool has_smoke() const {
    const auto any = [&](std::size_t level) {
      const std::span<const float> smoke = rows(levels_.smoke, level);
      return std::any_of(smoke.begin(), smoke.end(), is_thick);
    };
    return (layer_ < levels_.levels && any(layer_)) || (layer_ > 0 && any(layer_ - 1));
  }

  bool is_smoke(std::size_t y, std::size_t x) const {
    const std::array<std::size_t, 4> at = corners(y, x);
    const auto any = [&](std::size_t level) {
      const std::span<const float> smoke = rows(levels_.smoke, level);
      return std::any_of(at.begin(), at.end(), [&](std::size_t i) { return is_thick(smoke[i]); });
    };
    return any(layer_) || (layer_ > 0 && any(layer_ - 1));
  }

  /// Returns the positions of the band's nodes in the local frame: on the ground (0) or on level
  /// `number` - 1.
  std::vector<double> nodes(std::size_t number) const {
    const std::span<const float> lowest = rows(levels_.height, 0);
    const std::span<const float> from =
        number == 0 ? rows(levels_.ground, 0) : rows(levels_.height, number - 1);
    std::vector<double> height(from.begin(), from.end());
    for (std::size_t i = 0; number == 0 && i < height.size(); ++i) {
      height[i] = std::isfinite(height[i]) ? height[i] : static_cast<double>(lowest[i]);
    }
    std::vector<double> places(3 * height.size());
    frame_.forward_grid(levels_.latitude.subspan(first_, rows_), levels_.longitude, height, places);
    return places;
  }

  static CoordBox leaves_around(const Bounds& box, double voxel_size) {
    // The sides of a cell are curved: parallels at 85 degrees by d^2 / (8 * 560 km), meridians
    // less.
    const Vector extent = minus(box.high, box.low);
    const double bulge = 1.0 + dot(extent, extent) / 4.0e6; // m
    CoordBox leaves;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      leaves.low[axis] = leaf_number(box.low[axis] - bulge, voxel_size);
      leaves.high[axis] = leaf_number(box.high[axis] + bulge, voxel_size);
    }
    return leaves;
  }

  const geo::LocalFrame& frame_;
  const Levels& levels_;
  std::size_t columns_;
  std::size_t layer_;
  std::size_t first_; ///< first row
  std::size_t rows_;
};

} // namespace

std::vector<Coord> reached_leaves(const geo::LocalFrame& frame, const Levels& levels,
                                  double voxel_size) {
  const std::size_t cells = levels.latitude.size() - 1; // rows of cells
  const std::size_t bands = (cells + rows_in_band - 1) / rows_in_band;
  tbb::enumerable_thread_specific<LeafSet> sets{LeafSet(voxel_size)};
  tbb::parallel_for(std::size_t{0}, levels.levels * bands, [&](std::size_t i) {
    const std::size_t first = i % bands * rows_in_band;
    const Band band(frame, levels, i / bands, first, std::min(first + rows_in_band, cells));
    band.reach(voxel_size, sets.local());
  });
  LeafSet all(voxel_size);
  for (LeafSet& set : sets) {
    all.take(set);
  }
  return all.first_voxels();
}

} // namespace firetwin::volume
