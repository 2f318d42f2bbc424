#include "volume/dense_leaves.hpp"

#include "base/clones.hpp"
#include "volume/leaf_culling.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace firetwin::volume {
namespace {

constexpr auto side = static_cast<std::int32_t>(leaf_side);
constexpr std::int32_t block_side = 16 * side; // voxels; blocks are culled before their leaves
constexpr float largest_half = 65504.0F;
constexpr std::size_t lanes = 8;

/// Returns the largest magnitude as bits, which sort like the numbers; infinity and NaN are the
/// largest.
FIRETWIN_CLONES("avx2")
std::uint32_t largest_bits(const LeafValues& values) {
  std::uint32_t largest = 0;
  for (const float value : values) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    largest = std::max(largest, bits & 0x7fffffffU);
  }
  return largest;
}

/// Sums the values beyond the tolerance, in eight partial sums on any processor.
FIRETWIN_CLONES("avx2")
double sum_of(const LeafValues& values, float tolerance) {
  std::array<double, lanes> sums{};
  for (std::size_t i = 0; i < leaf_voxels; i += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const float value = values[i + lane];
      sums[lane] += static_cast<double>(std::abs(value) > tolerance ? value : 0.0F);
    }
  }
  return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
}

/// Writes 1 for each value beyond the tolerance, else 0.
FIRETWIN_CLONES("avx2")
void mark(const LeafValues& values, float tolerance, std::array<std::uint8_t, leaf_voxels>& marks) {
  for (std::size_t i = 0; i < leaf_voxels; ++i) {
    marks[i] = std::abs(values[i]) > tolerance ? 1 : 0;
  }
}

LeafMask active(const LeafValues& values, float tolerance) {
  std::array<std::uint8_t, leaf_voxels> marks;
  mark(values, tolerance, marks);
  LeafMask mask;
  for (std::size_t i = 0; i < leaf_voxels / 8; ++i) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, &marks[8 * i], sizeof eight);
    // In the product's highest byte, bit n is set if byte n of the factor is 1.
    const std::uint64_t bits = eight * 0x0102040810204080U >> 56;
    mask.words[i / 8] |= bits << i % 8 * 8;
  }
  return mask;
}

bool is_constant(const LeafValues& values) {
  return std::all_of(values.begin(), values.end(), [&](float v) { return v == values[0]; });
}

/// Origins of a field's leaves and tiles.
class OriginSet {
public:
  explicit OriginSet(const DenseLeaves& of) : origins_(of.leaves.origins) {
    for (const Tile& tile : of.tiles) {
      origins_.push_back(tile.origin);
    }
    std::sort(origins_.begin(), origins_.end());
  }

  bool contains(const Coord& origin) const {
    return std::binary_search(origins_.begin(), origins_.end(), origin);
  }

private:
  std::vector<Coord> origins_;
};

/// Visibility of blocks of 128^3 voxels. A block that contains a visible bounding sphere is visible
/// itself, so the leaves of invisible blocks need no test.
class VisibleBlocks {
public:
  VisibleBlocks(const DenseField& field, const LeafCulling& seen) {
    std::size_t size = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      count_[axis] = (field.shape[axis] - 1) / block_side + 1;
      size *= static_cast<std::size_t>(count_[axis]);
    }
    seen_.resize(size);
    tbb::parallel_for(std::size_t{0}, size, [&](std::size_t i) {
      const auto number = static_cast<std::int64_t>(i);
      const auto z = static_cast<std::int32_t>(number % count_[2]);
      const auto y = static_cast<std::int32_t>(number / count_[2] % count_[1]);
      const auto x = static_cast<std::int32_t>(number / count_[2] / count_[1]);
      const Coord lowest(x * block_side, y * block_side, z * block_side);
      seen_[i] = seen.is_visible(lowest, block_side) ? 1 : 0;
    });
  }

  bool is_visible(const Coord& voxel) const {
    const auto row =
        std::int64_t{voxel.x() / block_side} * count_[1] + std::int64_t{voxel.y() / block_side};
    return seen_[static_cast<std::size_t>(row * count_[2] + voxel.z() / block_side)] != 0;
  }

private:
  std::array<std::int32_t, 3> count_{};
  std::vector<char> seen_;
};

/// Scans a field leaf by leaf.
class LeafScan {
public:
  LeafScan(const DenseField& field, const DenseSettings& settings, bool sum_culled,
           const DenseLeaves* within)
      : field_(field), settings_(settings), sum_culled_(sum_culled),
        seen_(settings.view_set, settings.voxel_size, settings.origin), blocks_(field, seen_) {
    if (within != nullptr) {
      within_.emplace(*within);
    }
  }

  /// Scans the leaves of one column.
  void column(std::int32_t x, std::int32_t y, DenseLeaves& column) const {
    for (std::int32_t z = 0; z < field_.shape[2]; z += side) {
      const Coord origin(x, y, z);
      if (within_ && !within_->contains(origin)) {
        continue;
      }
      const bool counts = blocks_.is_visible(origin) && seen_.is_visible(origin, side);
      if (counts || sum_culled_) {
        leaf(origin, counts, column);
      }
    }
  }

private:
  void leaf(const Coord& origin, bool counts, DenseLeaves& column) const {
    LeafValues values;
    copy_leaf(field_, origin, values);
    const std::uint32_t largest = largest_bits(values);
    const float most = settings_.half ? largest_half : std::numeric_limits<float>::max();
    if (largest > std::bit_cast<std::uint32_t>(most)) {
      if (!column.bad) {
        column.bad = first_beyond(values, most, origin);
      }
      return;
    }
    if (largest <= std::bit_cast<std::uint32_t>(std::abs(settings_.tolerance))) {
      return;
    }
    (counts ? column.sum : column.culled_sum) += sum_of(values, settings_.tolerance);
    if (!counts) {
      return;
    }
    const LeafMask mask = active(values, settings_.tolerance);
    if (mask.is_full() && is_constant(values)) {
      column.tiles.push_back({origin, values[0]});
    } else {
      column.leaves.add(origin, mask);
    }
  }

  static Coord first_beyond(const LeafValues& values, float most, const Coord& origin) {
    const auto at = std::find_if_not(values.begin(), values.end(),
                                     [most](float value) { return std::abs(value) <= most; });
    const auto number = static_cast<std::int32_t>(at - values.begin());
    return origin.offset(number / side / side, number / side % side, number % side);
  }

  const DenseField& field_;
  const DenseSettings& settings_;
  bool sum_culled_;
  std::optional<OriginSet> within_;
  LeafCulling seen_;
  VisibleBlocks blocks_;
};

} // namespace

void copy_leaf(const DenseField& field, const Coord& origin, LeafValues& values) {
  const auto rest = [&](std::size_t axis) {
    return std::min(side, field.shape[axis] - origin[axis]);
  };
  const std::int32_t nx = rest(0);
  const std::int32_t ny = rest(1);
  const auto nz = static_cast<std::size_t>(rest(2));
  if (nx < side || ny < side || nz < leaf_side) {
    values.fill(0.0F);
  }
  for (std::int32_t x = 0; x < nx; ++x) {
    const std::int64_t plane = std::int64_t{origin.x() + x} * field.shape[1] + origin.y();
    for (std::int32_t y = 0; y < ny; ++y) {
      const float* row = field.values.data() + (plane + y) * field.shape[2] + origin.z();
      float* to = &values[static_cast<std::size_t>((x * side + y) * side)];
      if (nz == leaf_side) {
        std::memcpy(to, row, sizeof(float) * leaf_side); // a constant length is faster
      } else {
        std::memcpy(to, row, sizeof(float) * nz);
      }
    }
  }
}

DenseLeaves find_leaves(const DenseField& field, const DenseSettings& settings, bool sum_culled,
                        const DenseLeaves* within) {
  const LeafScan scan(field, settings, sum_culled, within);
  const auto rows = static_cast<std::size_t>((field.shape[1] - 1) / side + 1);
  std::vector<DenseLeaves> columns(static_cast<std::size_t>((field.shape[0] - 1) / side + 1) *
                                   rows);
  tbb::parallel_for(std::size_t{0}, columns.size(), [&](std::size_t i) {
    scan.column(static_cast<std::int32_t>(i / rows) * side,
                static_cast<std::int32_t>(i % rows) * side, columns[i]);
  });
  DenseLeaves all;
  for (const DenseLeaves& column : columns) {
    all.sum += column.sum;
    all.culled_sum += column.culled_sum;
    all.bad = all.bad ? all.bad : column.bad;
    for (std::size_t i = 0; i < column.leaves.size(); ++i) {
      all.leaves.add(column.leaves.origins[i], column.leaves.masks[i]);
    }
    all.tiles.insert(all.tiles.end(), column.tiles.begin(), column.tiles.end());
  }
  return all;
}

} // namespace firetwin::volume
